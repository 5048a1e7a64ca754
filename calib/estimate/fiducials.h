#pragma once

#include <glm/vec2.hpp>
#include <map>
#include <set>

#include "calib/geometry/camera_mapping.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The ArUco markers (DICT_4X4_50) in a photograph: id to the marker's centre, in undistorted camera pixels. The centre
/// is where the diagonals meet, which perspective keeps. Markers from about 24 pixels of side on are found; what only
/// resembles one is not. `wanted` (empty: all): the ids that matter. Throws EstimateError when one of them is seen
/// twice, with both places.
[[nodiscard]] std::map<int, glm::dvec2> findMarkers(const devices::Image8& photo, const CameraMapping& camera,
                                                    const std::set<int>& wanted = {});

}  // namespace pixelflex::calib
