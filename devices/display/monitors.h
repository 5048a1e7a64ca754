#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "devices/display/event_loop.h"
#include "devices/image/size.h"

namespace pixelflex::devices {

struct Monitor {
  std::string name;           // RandR's, e.g. HDMI-1, or as made by xrandr --setmonitor
  glm::ivec2 position{0, 0};  // on the display, pixels
  Size size;
  bool operator==(const Monitor&) const = default;
};

/// The monitors that are switched on, the primary one first.
[[nodiscard]] std::vector<Monitor> listMonitors(const EventLoop& loop);

/// Throws DisplayError with the names there are.
[[nodiscard]] Monitor findMonitor(const EventLoop& loop, const std::string& name);

}  // namespace pixelflex::devices
