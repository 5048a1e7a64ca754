#include "devices/display/event_loop.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <utility>

#include "devices/display/display_error.h"
#include "devices/display/glfw_error.h"

namespace pixelflex::devices {
namespace {

bool& loopExists() {
  static bool exists = false;
  return exists;
}

std::string displayName() {
  const char* const name = std::getenv("DISPLAY");
  return name != nullptr ? fmt::format("display '{}'", name) : "no display (DISPLAY is not set)";
}

}  // namespace

std::string lastGlfwError() {
  const char* text = nullptr;
  const int code = glfwGetError(&text);
  return code == GLFW_NO_ERROR ? "no reason given" : std::string(text);
}

EventLoop::EventLoop(const std::optional<std::string>& display) {
  assert(!loopExists());
  glfwTerminate();  // of an earlier loop, perhaps on another display
  if (display) setenv("DISPLAY", display->c_str(), 1);
  if (glfwInit() != GLFW_TRUE) {
    throw DisplayError(fmt::format("cannot open windows on {}: {}; start an X server, set DISPLAY, or use --headless",
                                   displayName(), lastGlfwError()));
  }
  loopExists() = true;
}

// GLFW stays as it is until another loop begins or the process ends: the X server's and the driver's libraries lose
// memory each time that they are unloaded.
EventLoop::~EventLoop() {
  loopExists() = false;
}

void EventLoop::wait(std::optional<std::chrono::duration<double>> timeout) {
  if (timeout) {
    glfwWaitEventsTimeout(std::max(timeout->count(), 1e-6));
  } else {
    glfwWaitEvents();
  }
  finish();
}

void EventLoop::poll() {
  glfwPollEvents();
  finish();
}

void EventLoop::wake() {
  glfwPostEmptyEvent();
}

void EventLoop::finish() {
  for (const auto& [owner, task] : tasks_) task();
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

}  // namespace pixelflex::devices
