#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

namespace pixelflex::devices {

/// A key that went down (again, while it is held) or up, as an X11 keysym.
struct KeyStroke {
  std::uint32_t keysym = 0;
  bool pressed = false;
  /// With Ctrl, the small Latin letter on the key, for shortcuts that work in every layout; see letterOnKey(). 0: none.
  char letter = 0;
  bool operator==(const KeyStroke&) const = default;
};

/// The keys pressed in one window, as keysyms by the display's layout, with levels, groups, locks and dead keys as the
/// X server itself counts them. The windowing library tells less: it drops modifiers and knows no groups. A release has
/// the keysym of its press, whatever the modifiers have become since; keys held when the keyboard goes elsewhere or a
/// grab ends are released.
class Keysyms {
 public:
  /// On a connection of its own to the environment's display, to follow the layout when it is changed. `window` is X's
  /// number. Throws DisplayError.
  explicit Keysyms(unsigned long window);
  ~Keysyms();
  Keysyms(const Keysyms&) = delete;
  Keysyms& operator=(const Keysyms&) = delete;

  /// What has happened since the last call, in order; with `all` what the server knows by now, which takes a way there
  /// and back.
  [[nodiscard]] std::vector<KeyStroke> take(bool all);
  /// Readable when something has happened.
  [[nodiscard]] int descriptor() const;

  /// All keys come here, also those that a window manager would take for itself, until it is let go. False when another
  /// program has the keyboard to itself.
  bool grab();
  void letGo();

 private:
  struct Connection;
  struct Held {
    std::uint32_t keysym = 0;
    char letter = 0;
  };
  void press(unsigned keycode, Held now);
  void release(unsigned keycode);
  void releaseAll();

  std::unique_ptr<Connection> connection_;
  std::unordered_map<unsigned, Held> pressed_;  // by keycode
  std::vector<KeyStroke> strokes_;
};

}  // namespace pixelflex::devices
