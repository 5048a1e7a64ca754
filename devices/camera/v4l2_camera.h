#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/camera/camera.h"
#include "devices/camera/camera_info.h"
#include "devices/camera/video_device.h"

namespace pixelflex::devices {

/// The cameras among /dev/video*.
[[nodiscard]] std::vector<CameraInfo> listV4l2Cameras();

/// `path`: "/dev/video0", or a link to one that stays (/dev/v4l/by-id/…). Its largest pictures, uncompressed where that
/// costs no size; exposure, gain, white balance and focus made manual, each read back. Frames that were exposed before
/// a photograph was asked for, by their time stamps, are dropped. Throws CameraError.
[[nodiscard]] std::unique_ptr<Camera> openV4l2Camera(const std::string& path);

/// The same with a device that is open already; `source` is what messages call it.
[[nodiscard]] std::unique_ptr<Camera> makeV4l2Camera(const std::string& source, std::unique_ptr<VideoDevice> device);

}  // namespace pixelflex::devices
