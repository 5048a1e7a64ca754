#pragma once

#include <array>
#include <span>
#include <vector>

#include "calib/photometric/black_lift.h"
#include "calib/photometric/gamut.h"
#include "calib/photometric/wall_raster.h"

namespace pixelflex::calib {

/// What the lift of each projector is made of: its linear red, green and blue, which together have the luminance of its
/// own white. Leaks are tinted as the projectors' whites are; so that black is of one colour too, the lift fills up
/// what is missing to the colour of the wall's brightest black, in the mean over the projector's part of the wall.
/// `primaries`: as for commonGamut; `projectors`: as for blackTarget.
[[nodiscard]] std::vector<std::array<double, 3>> liftColours(std::span<const Matrix3> primaries,
                                                             std::span<const ProjectorLightMaps> projectors,
                                                             const BlackTarget& black,
                                                             const std::array<double, 3>& luminance = kCameraLuminance);

}  // namespace pixelflex::calib
