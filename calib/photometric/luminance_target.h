#pragma once

#include <span>

#include "calib/geometry/projector_mapping.h"
#include "calib/photometric/wall_raster.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The luminance that the wall's white is to have.
struct LuminanceTarget {
  devices::ImageF available;  // what the projectors can make with their shares; 0 where none reaches
  devices::ImageF target;     // nowhere more
  double kept = 1;            // of the light that the shares alone would give: what the target costs
};

/// The width of the display as the audience sees it from a usual place.
inline constexpr double kDisplayDegrees = 60;

/// The steepest relative change of the target per degree of view: 10 % (uniformity 0: only what hides seams), 0.55 % (a
/// half: not seen), 0 (1: the same luminance everywhere).
[[nodiscard]] double luminanceGradientPerDegree(double uniformity);

/// `uniformity` 0..1 from brightest to flattest; more of it nowhere makes more light. `pixelsPerDegree` is how many
/// pixels of the raster the audience sees in a degree. Throws LightError where nothing is lit.
[[nodiscard]] LuminanceTarget luminanceTarget(std::span<const ProjectorLightMaps> projectors, double uniformity,
                                              double pixelsPerDegree);

/// What one projector's white must be multiplied with to be its share of the target: 65535 = 1, `size` samples
/// stretched over its frame, each taken at its middle. Where the projector is too weak for the target by a little
/// (where its share is next to nothing) it gives all it has.
[[nodiscard]] devices::Image16 gainMap(const ProjectorMapping& projector, const devices::ImageF& white,
                                       const devices::ImageF& target, const WallRaster& raster, devices::Size size);

}  // namespace pixelflex::calib
