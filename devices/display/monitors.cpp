#include "devices/display/monitors.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "devices/display/display_error.h"

namespace pixelflex::devices {

std::vector<Monitor> listMonitors(const EventLoop& /*loop*/) {
  int count = 0;
  GLFWmonitor** const handles = glfwGetMonitors(&count);
  std::vector<Monitor> monitors;
  for (int i = 0; i < count; ++i) {
    Monitor monitor;
    monitor.name = glfwGetMonitorName(handles[i]);
    glfwGetMonitorPos(handles[i], &monitor.position.x, &monitor.position.y);
    if (const GLFWvidmode* const mode = glfwGetVideoMode(handles[i])) {
      monitor.size = {mode->width, mode->height};
      monitor.refreshRate = mode->refreshRate;
    }
    monitors.push_back(monitor);
  }
  return monitors;
}

Monitor findMonitor(const EventLoop& loop, const std::string& name) {
  std::string names;
  for (const auto& monitor : listMonitors(loop)) {
    if (monitor.name == name) return monitor;
    names += (names.empty() ? "" : ", ") + monitor.name;
  }
  throw DisplayError(fmt::format("there is no monitor '{}'; there are: {}", name, names.empty() ? "none" : names));
}

}  // namespace pixelflex::devices
