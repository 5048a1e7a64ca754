#include "devices/camera/cameras.h"

#include <array>
#include <iterator>

#include "devices/camera/aravis_camera.h"
#include "devices/camera/camera_error.h"
#include "devices/camera/still_camera.h"
#include "devices/camera/v4l2_camera.h"

namespace pixelflex::devices {
namespace {

struct Kind {
  std::string_view prefix;
  std::vector<CameraInfo> (*list)();
  std::unique_ptr<Camera> (*open)(const std::string& name);
};
constexpr std::array kKinds = {Kind{"v4l2:", listV4l2Cameras, openV4l2Camera},
                               Kind{"aravis:", listAravisCameras, openAravisCamera},
                               Kind{"gphoto2:", listStillCameras, openStillCamera}};

}  // namespace

std::vector<CameraInfo> listCameras() {
  std::vector<CameraInfo> cameras;
  for (const Kind& kind : kKinds) {
    auto its = kind.list();
    std::ranges::move(its, std::back_inserter(cameras));
  }
  return cameras;
}

std::unique_ptr<Camera> openCamera(const std::string& source) {
  for (const Kind& kind : kKinds) {
    if (source.starts_with(kind.prefix)) return kind.open(source.substr(kind.prefix.size()));
  }
  throw CameraError(source +
                    ": not a camera that can be driven from here: v4l2:DEVICE, aravis:NAME and gphoto2:NAME are; "
                    "pixelflex camera list shows those there are");
}

}  // namespace pixelflex::devices
