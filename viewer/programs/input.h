#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>

#include "devices/display/window.h"
#include "viewer/programs/wall_view.h"

namespace pixelflex::viewer {

/// Pointer and keyboard of all windows of a wall, on their way to the desktop. Main thread.
class Input {
 public:
  /// `view` must outlive this and the windows. `onQuit` is called for Ctrl+Alt+Q and closed windows.
  Input(WallView& view, std::function<void()> onQuit) : view_(view), onQuit_(std::move(onQuit)) {}

  /// Handlers for a window; `desktopFromWindow` finds the desktop pixel under a window pixel.
  using Map = std::function<std::optional<glm::ivec2>(glm::dvec2 pointInWindow)>;
  [[nodiscard]] devices::WindowHandlers handlers(Map desktopFromWindow, std::function<void()> redraw);

 private:
  void move(std::optional<glm::ivec2> pointInDesktop);
  void button(int number, bool pressed);
  void scroll(glm::dvec2 steps);
  void key(std::uint32_t keysym, bool pressed);

  WallView& view_;
  std::function<void()> onQuit_;
  glm::ivec2 position_{0, 0};
  std::uint8_t buttons_ = 0;
  glm::dvec2 unscrolled_{0, 0};
  bool control_ = false;
  bool alt_ = false;
};

}  // namespace pixelflex::viewer
