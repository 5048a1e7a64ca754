#pragma once

#include <glm/vec2.hpp>
#include <map>

#include "calib/geometry/camera_mapping.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The ArUco markers (DICT_4X4_50) in a photograph: id to the marker's centre, in undistorted camera pixels. The centre
/// is where the diagonals meet, which perspective keeps.
[[nodiscard]] std::map<int, glm::dvec2> findMarkers(const devices::Image8& photo, const CameraMapping& camera);

}  // namespace pixelflex::calib
