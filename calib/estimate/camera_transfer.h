#pragma once

#include "calib/estimate/camera_response.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// A camera that encodes light as sRGB says.
[[nodiscard]] CameraResponse srgbCamera();

/// The linear or the sRGB curve where a measured one is that within what it may be wrong by, else the measured one
/// itself; its error stays.
[[nodiscard]] CameraResponse nearestStandard(const CameraResponse& measured);

/// Light of every pixel, 0 to 1, of a three-channel photograph.
[[nodiscard]] devices::ImageF linearised(const devices::Image8& photo, const CameraResponse& camera);

}  // namespace pixelflex::calib
