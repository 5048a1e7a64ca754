#pragma once

#include <string>

#include "devices/image/size.h"

namespace pixelflex::devices {

/// A camera that could be used.
struct CameraInfo {
  std::string address;  // as wall.yaml names it: "v4l2:/dev/video0", "aravis:NAME", "gphoto2:NAME"
  std::string model;
  Size size;        // of its photographs; 0x0 where only opening it would tell
  std::string why;  // why it cannot be used now; empty when it can
};

}  // namespace pixelflex::devices
