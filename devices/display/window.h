#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "devices/display/event_loop.h"
#include "devices/display/gl_context.h"
#include "devices/display/gl_handle.h"
#include "devices/display/keysyms.h"
#include "devices/image/size.h"

namespace pixelflex::devices {

struct WindowRequest {
  std::string title;
  Size size;
  std::optional<glm::ivec2> at;  // top-left corner on the display; none: where the window manager likes
  bool borderless = false;       // and above others: a projector's picture
  bool visible = true;           // false: only a GL context
  bool paced = false;            // present() waits for the monitor's refresh; at most one window of a wall
  bool showPointer = true;       // the system's own pointer, over this window
  int bitsPerColour = 8;         // wished for; what the display gives is told by Window::bitsPerColour()
};

/// A part of a picture, pixels.
struct Part {
  glm::ivec2 topLeft{0, 0};
  Size size;
};

/// What happens to a window, called from EventLoop::wait() and poll() on the main thread. Each may be empty.
struct WindowHandlers {
  std::function<void(glm::dvec2 position)> pointer;  // window pixels from the top-left corner; outside it during a drag
  std::function<void(glm::dvec2 by)> motion;         // in the pointer's stead while it is locked: pixels
  std::function<void(int button, bool pressed)> button;  // X numbers: 1 left, 2 middle, 3 right, 8 back, 9 forward
  std::function<void(glm::dvec2 steps)> scroll;          // wheel notches, up and left positive
  std::function<void(const KeyStroke& stroke)> key;      // modifiers too; repeats are presses
  std::function<void(bool focused)> focus;               // the keyboard has come or gone
  std::function<void()> close;
  std::function<void()> redraw;  // shown for the first time, uncovered or resized: present() again
};

/// A window with its GL 4.5 core context.
class Window final : public GlContext {
 public:
  /// Shown and current. `share`: a window whose textures and buffers this one shall see. Throws DisplayError.
  Window(EventLoop& loop, const WindowRequest& request, const Window* share = nullptr);
  ~Window() override;
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  void setHandlers(WindowHandlers handlers);

  void makeCurrent() override;

  /// Of the picture, in pixels.
  [[nodiscard]] Size size() const;
  /// Of the window's framebuffer, the fewest of the three colours.
  [[nodiscard]] int bitsPerColour();
  /// Of the top-left corner on the display.
  [[nodiscard]] glm::ivec2 position() const;
  /// Locked, the pointer is hidden and stays in this window while that has the keyboard; only its motion is told.
  void lockPointer(bool locked);
  /// All keys come to this window, shortcuts of the window manager too. False when another program has the keyboard to
  /// itself: worth another try. Keys that are held are let go when it ends.
  bool grabKeyboard();
  void releaseKeyboard();
  /// Moves it; a window manager may have its own mind.
  void moveTo(glm::ivec2 position);
  /// present() waits for the monitor's refresh; at most one window of a wall. Leaves this context current.
  void pace(bool paced);
  /// Hidden, it is off the screen but keeps its context.
  void show(bool shown);
  void setTitle(const std::string& title);

  /// Shows a GL_TEXTURE_2D whose row 0 is the top, filling the window, and swaps. The texture must be finished. Leaves
  /// this context current.
  void present(GlName texture, Size textureSize);
  /// Shows only these parts of it anew where that is cheaper; the rest of the window shows the same texture as it was
  /// presented before.
  void present(GlName texture, Size textureSize, std::span<const Part> parts);
  /// Shows what was drawn into the window's own framebuffer.
  void swap();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pixelflex::devices
