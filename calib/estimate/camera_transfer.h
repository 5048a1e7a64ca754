#pragma once

#include "calib/estimate/camera_response.h"

namespace pixelflex::calib {

/// A camera that encodes light as sRGB says.
[[nodiscard]] CameraResponse srgbCamera();

/// The linear or the sRGB curve where a measured one is that within what it may be wrong by, else the measured one
/// itself; its error stays.
[[nodiscard]] CameraResponse nearestStandard(const CameraResponse& measured);

}  // namespace pixelflex::calib
