#pragma once

#include "calib/simulate/raster_view.h"
#include "calib/simulate/rig.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// Part of the light that a point of the wall throws back: the white screen is 1, the markers' paper a little less,
/// black ink and the surround little.
[[nodiscard]] double reflectanceOfWall(const Rig& rig, glm::dvec2 pointInWall);

/// The room light at a point of the wall, 1 at its brightest corner.
[[nodiscard]] double roomLightAt(const Rig& rig, glm::dvec2 pointInWall);

/// The wall's own look in a raster, one channel each, averaged over every pixel's area.
struct RoomRaster {
  devices::ImageF reflectance;
  devices::ImageF ambient;  // radiance under room light of level 1, with the view's transmission
};
[[nodiscard]] RoomRaster lookAtRoom(const Rig& rig, const RasterView& view);

}  // namespace pixelflex::calib
