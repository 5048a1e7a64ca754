#pragma once

#include <cstddef>
#include <span>

#include "calib/geometry/projector_mapping.h"
#include "calib/photometric/wall_raster.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The luminance that the wall's black is to have: projectors leak light where they show black, and it adds up where
/// they overlap; the rest of the wall is lifted to it.
struct BlackTarget {
  devices::ImageF target;     // unit of the maps; nowhere below what leaks
  double largestLift = 0;     // of a projector's own white
  double contrastNative = 0;  // mean white over mean black of the display area, as it leaks
  double contrastEven = 0;    // after the lift
};

/// `luminance` is the target of white. `gradient` bounds the relative change of black per pixel of the raster; 0 makes
/// it the same everywhere, more of it costs less contrast. Every projector's black must be known. Throws LightError
/// where nothing is lit.
[[nodiscard]] BlackTarget blackTarget(std::span<const ProjectorLightMaps> projectors, const devices::ImageF& luminance,
                                      double gradient);

/// What one projector adds to its linear light, already times its share `alpha` (a 16-bit mask of its resolution):
/// 65535 = `largest` of its own white; lifts beyond it are cut off. The borders of the other frames are taken from the
/// mappings, so the lift changes exactly where their leak begins. White that leaves no room for the lift would be
/// clipped: let the luminance target be made from white maps times (1 - largestLift).
[[nodiscard]] devices::Image16 blackLiftMap(std::size_t own, std::span<const ProjectorMapping> mappings,
                                            std::span<const ProjectorLightMaps> projectors, const BlackTarget& black,
                                            const WallRaster& raster, const devices::Image16& alpha, double largest);

}  // namespace pixelflex::calib
