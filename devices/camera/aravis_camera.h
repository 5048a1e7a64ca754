#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/camera/camera.h"
#include "devices/camera/camera_info.h"

namespace pixelflex::devices {

/// The GigE Vision and USB3 Vision cameras that answer now. Takes about a second.
[[nodiscard]] std::vector<CameraInfo> listAravisCameras();

/// `name`: a camera's id, serial number, model, or network address, or "first". Its whole sensor, everything automatic
/// switched off and read back. Each photograph is triggered by software where the camera offers that; elsewhere frames
/// are dropped until one's exposure has begun after the call. Throws CameraError.
[[nodiscard]] std::unique_ptr<Camera> openAravisCamera(const std::string& name);

}  // namespace pixelflex::devices
