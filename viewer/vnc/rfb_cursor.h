#pragma once

#include <cstdint>
#include <span>

#include "viewer/vnc/session_event.h"

namespace pixelflex::viewer {

/// `colours` four bytes a pixel (red, green, blue, undefined), `mask` one byte a pixel, 0 or 1.
[[nodiscard]] CursorShape cursorFromMask(devices::Size size, std::span<const std::uint8_t> colours,
                                         std::span<const std::uint8_t> mask);

/// Four bytes a pixel, red, green, blue premultiplied with the alpha that follows them.
[[nodiscard]] CursorShape cursorFromPremultiplied(devices::Size size, std::span<const std::uint8_t> rgba);

}  // namespace pixelflex::viewer
