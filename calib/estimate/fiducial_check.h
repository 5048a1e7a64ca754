#pragma once

#include <optional>
#include <span>
#include <string>

#include "calib/estimate/collineation.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// What is probably wrong with the places that were written down for the fiducials of a flat wall: one mistyped, two
/// exchanged, or four that no camera of this focal length sees so. None when they fit together, or when the misfit has
/// no such simple cause. `pairs`: undistorted camera pixel to wall, at least four; `names`: theirs, for the text.
[[nodiscard]] std::optional<std::string> explainFiducials(std::span<const PointPair> pairs,
                                                          std::span<const std::string> names,
                                                          const CameraIntrinsics& camera);

}  // namespace pixelflex::calib
