#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/camera/camera.h"
#include "devices/camera/camera_info.h"
#include "devices/camera/still_device.h"

namespace pixelflex::devices {

/// The cameras that libgphoto2 finds on USB.
[[nodiscard]] std::vector<CameraInfo> listStillCameras();

/// `name`: as openStillDevice(). Manual exposure and focus, fixed sensitivity and white balance, its largest JPEG;
/// takes one photograph to learn their extent. Throws CameraError, naming what the camera does not let itself be set
/// to.
[[nodiscard]] std::unique_ptr<Camera> openStillCamera(const std::string& name);

/// The same with a device that is open already; `source` is what messages call it.
[[nodiscard]] std::unique_ptr<Camera> makeStillCamera(const std::string& source, std::unique_ptr<StillDevice> device);

/// The seconds that a camera's menu means: "1/60", "0.5", "2", "0.0166s", "1.3\""; none for "bulb" and other words.
[[nodiscard]] std::optional<double> shutterSeconds(std::string_view text);

}  // namespace pixelflex::devices
