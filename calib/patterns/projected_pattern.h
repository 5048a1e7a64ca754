#pragma once

#include <functional>
#include <string>

#include "devices/image/image.h"

namespace pixelflex::calib {

/// A picture that a projector shows while it is photographed.
struct ProjectedPattern {
  std::string name;                         // of its file, without the ending
  std::string description;                  // what a person sees in it
  std::function<devices::Image8()> render;  // of the projector's resolution, one or three channels of device codes
};

}  // namespace pixelflex::calib
