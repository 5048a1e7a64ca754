#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

namespace pixelflex::devices {

/// Modifiers as the windowing library reports them with an event.
struct KeyModifiers {
  bool shift = false;
  bool capsLock = false;
  bool numLock = false;
};

/// Turns hardware keys into X11 keysyms by the display's keyboard layout. A release gives the keysym of its press,
/// whatever the modifiers have become since.
class Keysyms {
 public:
  /// Opens a connection of its own to the environment's display, to follow the layout when it is changed. Throws
  /// DisplayError.
  Keysyms();
  ~Keysyms();
  Keysyms(const Keysyms&) = delete;
  Keysyms& operator=(const Keysyms&) = delete;

  /// None when the key means nothing in this layout.
  [[nodiscard]] std::optional<std::uint32_t> press(int keycode, KeyModifiers modifiers);
  /// None when it was not pressed here.
  [[nodiscard]] std::optional<std::uint32_t> release(int keycode);
  /// The window lost the keyboard: everything still pressed.
  [[nodiscard]] std::vector<std::uint32_t> releaseAll();

 private:
  struct Connection;
  void followLayout();
  [[nodiscard]] unsigned stateOf(KeyModifiers modifiers) const;

  std::unique_ptr<Connection> connection_;
  std::unordered_map<int, std::uint32_t> pressed_;  // keysym by keycode
};

}  // namespace pixelflex::devices
