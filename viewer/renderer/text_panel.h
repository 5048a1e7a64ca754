#pragma once

#include <span>
#include <string>

#include "devices/image/image.h"

namespace pixelflex::viewer {

/// Lines of text, white on a dark pane that lets some of what is behind shine through: red, green, blue and alpha, not
/// multiplied. Digits, letters (all small) and . , : / - %; anything else is a blank. Letters have 5x8 pixels of
/// `scale` each.
[[nodiscard]] devices::Image8 textPanel(std::span<const std::string> lines, int scale);

}  // namespace pixelflex::viewer
