#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "devices/image/size.h"

namespace pixelflex::viewer {

/// Decodes a JPEG picture of exactly `size` pixels to red, green, blue and a byte without meaning each, rows
/// `rowBytes` apart from `out` on. False when it is no such picture; then some rows may be written. (libvncclient's own
/// decoder reads beyond the end of a picture whose markers lie.)
[[nodiscard]] bool decodeJpegRect(std::span<const std::uint8_t> jpeg, devices::Size size, std::uint8_t* out,
                                  std::size_t rowBytes);

}  // namespace pixelflex::viewer
