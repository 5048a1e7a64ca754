#pragma once

#include <X11/Xlib.h>
#include <sys/types.h>

#include <cstdint>
#include <string>

namespace pixelflex::testing {

/// An Xvfb of its own on a free display, which becomes the process's DISPLAY, without window manager; ends with this.
class XServer {
 public:
  /// Throws std::runtime_error when it does not start.
  XServer(int width, int height, int depth = 24);
  ~XServer();
  XServer(const XServer&) = delete;
  XServer& operator=(const XServer&) = delete;

  [[nodiscard]] const std::string& display() const { return display_; }
  /// Colour on the screen as 0xRRGGBB; ten bits for each of the three when the depth is 30.
  [[nodiscard]] std::uint32_t colourAt(int x, int y) const;
  /// Asks the window with this title to close, as a window manager does. False when there is none.
  [[nodiscard]] bool askToClose(const std::string& title) const;

 private:
  [[nodiscard]] ::Window findWindow(const std::string& title) const;
  pid_t process_ = -1;
  std::uint32_t pixelMask_ = 0xFFFFFF;
  std::string display_;
  Display* connection_ = nullptr;
};

}  // namespace pixelflex::testing
