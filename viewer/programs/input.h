#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <set>
#include <vector>

#include "devices/display/window.h"
#include "viewer/programs/control_taps.h"
#include "viewer/programs/pointer_shake.h"
#include "viewer/programs/wall_view.h"

namespace pixelflex::viewer {

/// Pointer and keyboard of all windows of a wall, on their way to the desktop. Main thread.
class Input {
 public:
  /// What shortcuts do that are not the desktop's.
  struct Commands {
    std::function<void()> quit;   // Ctrl+Alt+Q, and closed windows
    std::function<void()> stats;  // Ctrl+Alt+S
  };
  /// `view` must outlive this and the windows.
  Input(WallView& view, Commands commands) : view_(view), commands_(std::move(commands)) {}

  /// Takes a window's pointer and keys; the window must outlive this. `desktopFromWindow` finds the desktop pixel under
  /// a window pixel. `joins`: a drag out of this window goes on in the next one that joins, and lockPointer() holds.
  using Map = std::function<std::optional<glm::ivec2>(glm::dvec2 pointInWindow)>;
  void take(devices::Window& window, Map desktopFromWindow, std::function<void()> redraw, bool joins);

  /// Locked, the pointer moves over the desktop as the mouse does, wherever the windows lie. Ctrl+Alt+G lets pointer
  /// and keyboard go, and takes them again.
  void lockPointer();
  /// From here on all keys go to the desktop while one of the windows has the focus, also the window manager's
  /// shortcuts. Ctrl+Alt+G does the same.
  void grabKeyboard();

 private:
  struct Pane {
    devices::Window* window = nullptr;
    Map map;
    bool joins = false;
  };
  void move(std::optional<glm::ivec2> pointInDesktop);
  void moveIn(std::size_t pane, glm::dvec2 pointInWindow);
  [[nodiscard]] std::optional<glm::ivec2> besides(const Pane& pane, glm::dvec2 pointInWindow) const;
  void moveBy(glm::dvec2 pixels);
  void button(int number, bool pressed);
  void scroll(glm::dvec2 steps);
  void key(const devices::KeyStroke& stroke);
  void focus(std::size_t pane, bool focused);
  [[nodiscard]] bool takenAsCommand(const devices::KeyStroke& stroke);
  void setLock(bool locked);
  void setGrab(bool grabs);
  void followFocus();

  WallView& view_;
  const Commands commands_;
  std::vector<Pane> panes_;
  std::uint16_t buttons_ = 0;
  glm::dvec2 unscrolled_{0, 0};
  glm::dvec2 unmoved_{0, 0};              // less than a pixel
  std::set<std::uint32_t> modifiers_;     // of Ctrl and Alt, those that are down
  std::optional<std::uint32_t> command_;  // the key of a shortcut for us, until it is up
  ControlTaps taps_;
  PointerShake shake_;
  bool lockable_ = false;
  bool locked_ = false;
  bool grabs_ = false;
  std::optional<std::size_t> focused_;  // pane
  std::optional<std::size_t> grabbed_;  // pane
};

}  // namespace pixelflex::viewer
