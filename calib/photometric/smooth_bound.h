#pragma once

#include "devices/image/image.h"

namespace pixelflex::calib {

/// The largest smooth field below another whose relative gradient nowhere exceeds `gradient` per pixel, nearly: its
/// logarithm is bounded in every direction and then rounded over a few pixels, where bends would show as Mach bands.
/// Zero of the field is outside: no bound there, and zero in the result. With gradient 0 the smallest value. The two
/// sweeps follow Majumder and Stevens, Perceptual photometric seamlessness in projection-based tiled displays (2005).
[[nodiscard]] devices::ImageF smoothBelow(const devices::ImageF& field, double gradient);

/// The smallest such field above another.
[[nodiscard]] devices::ImageF smoothAbove(const devices::ImageF& field, double gradient);

}  // namespace pixelflex::calib
