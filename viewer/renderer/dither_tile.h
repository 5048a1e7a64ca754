#pragma once

#include "devices/image/image.h"

namespace pixelflex::viewer {

inline constexpr int kDitherExtent = 64;

/// Blue noise: a tile without visible clumps or grain of any size that goes on over its borders, each of the 256 values
/// equally often, three channels of it that are not alike. Always the same. Takes some ten milliseconds.
[[nodiscard]] devices::Image8 makeDitherTile();

}  // namespace pixelflex::viewer
