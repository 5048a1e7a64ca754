#pragma once

#include <cstdint>

namespace pixelflex::devices {

/// A raster's extent in pixels.
struct Size {
  int width = 0;
  int height = 0;

  /// The number of pixels, in 64 bits: a 16384x16384 desktop times four bytes does not fit into 31.
  [[nodiscard]] std::int64_t area() const { return std::int64_t{width} * height; }
  bool operator==(const Size&) const = default;
};

}  // namespace pixelflex::devices
