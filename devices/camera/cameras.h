#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/camera/camera.h"
#include "devices/camera/camera_info.h"

namespace pixelflex::devices {

/// Every camera that this machine could use now, of all kinds. Takes about a second.
[[nodiscard]] std::vector<CameraInfo> listCameras();

/// A camera by what wall.yaml calls its source: "v4l2:DEVICE", "aravis:NAME", "gphoto2:NAME", NAME also "first". Manual
/// in everything, as far as it lets itself be set. Throws CameraError.
[[nodiscard]] std::unique_ptr<Camera> openCamera(const std::string& source);

}  // namespace pixelflex::devices
