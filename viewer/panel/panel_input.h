#pragma once

#include <cstdint>
#include <deque>
#include <glm/vec2.hpp>
#include <variant>

#include "devices/display/keysyms.h"

namespace pixelflex::viewer {

/// What a person does with the panel's window, handed to the toolkit in frames: no more in one than it can tell apart,
/// so that a click shorter than a frame is not lost. Main thread.
class PanelInput {
 public:
  void movePointer(glm::dvec2 position) { events_.emplace_back(position); }
  void pressButton(int button, bool pressed) { events_.emplace_back(Button{button, pressed}); }
  void scroll(glm::dvec2 steps) { events_.emplace_back(Scroll{steps}); }
  void pressKey(const devices::KeyStroke& stroke) { events_.emplace_back(stroke); }

  /// Prepares the toolkit's current context for keys; once.
  static void begin();
  /// Of the next frame.
  void apply();
  [[nodiscard]] bool waits() const { return !events_.empty(); }

 private:
  struct Button {
    int button;  // X's number
    bool pressed;
  };
  struct Scroll {
    glm::dvec2 steps;
  };
  using Event = std::variant<glm::dvec2, Button, Scroll, devices::KeyStroke>;

  std::deque<Event> events_;
};

}  // namespace pixelflex::viewer
