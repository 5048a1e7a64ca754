#include "devices/display/event_loop.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3native.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include "devices/display/display_error.h"
#include "devices/display/glfw_error.h"

namespace pixelflex::devices {
namespace {

bool& loopExists() {
  static bool exists = false;
  return exists;
}

/// The windowing library's own way to end a wait does not know of our descriptors.
int wakeDescriptor() {
  static const int descriptor = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  return descriptor;
}

bool& serverIsGone() {
  static bool gone = false;
  return gone;
}

/// Without this, Xlib would end the process with a message of its own.
void outliveServer() {
  serverIsGone() = false;
  XSetIOErrorHandler([](Display* /*x*/) { return 0; });
  XSetIOErrorExitHandler(
      glfwGetX11Display(), [](Display* /*x*/, void* /*nothing*/) { serverIsGone() = true; }, nullptr);
}

int millisecondsOf(std::optional<std::chrono::duration<double>> timeout) {
  if (!timeout) return -1;
  const double milliseconds = std::ceil(timeout->count() * 1e3);
  return static_cast<int>(std::clamp(milliseconds, 0.0, double(std::numeric_limits<int>::max())));
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
  outliveServer();
  loopExists() = true;
}

// GLFW stays as it is until another loop begins or the process ends: the X server's and the driver's libraries lose
// memory each time that they are unloaded.
EventLoop::~EventLoop() {
  loopExists() = false;
}

void EventLoop::wait(std::optional<std::chrono::duration<double>> timeout) {
  // Drawing may have read events from the socket, for which it will not wake us.
  if (XPending(glfwGetX11Display()) == 0) sleep(timeout);
  poll();
}

void EventLoop::sleep(std::optional<std::chrono::duration<double>> timeout) const {
  std::vector<pollfd> watched{{ConnectionNumber(glfwGetX11Display()), POLLIN, 0}, {wakeDescriptor(), POLLIN, 0}};
  for (const auto& [owner, task] : tasks_) watched.push_back({task.descriptor, POLLIN, 0});
  ::poll(watched.data(), watched.size(), millisecondsOf(timeout));
}

void EventLoop::poll() {
  eventfd_t wakes = 0;
  eventfd_read(wakeDescriptor(), &wakes);
  glfwPollEvents();
  finish();
}

void EventLoop::wake() {
  eventfd_write(wakeDescriptor(), 1);
}

void EventLoop::finish() {
  for (const auto& [owner, task] : tasks_) task.run();
  if (serverIsGone()) throw DisplayError("the X server of " + displayName() + " is gone");
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

}  // namespace pixelflex::devices
