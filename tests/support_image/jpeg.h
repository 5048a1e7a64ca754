#pragma once

#include <cstdint>
#include <vector>

#include "devices/image/image.h"

namespace pixelflex::testing {

/// A JPEG file of an image with one or three channels, as good as servers and cameras send it.
[[nodiscard]] std::vector<std::uint8_t> jpegOf(const devices::Image8& image);

}  // namespace pixelflex::testing
