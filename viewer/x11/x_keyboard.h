#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "viewer/x11/x_connection.h"

namespace pixelflex::viewer {

/// A keyboard on an X server that can press any symbol: one that the layout has somewhere is pressed there, with Shift
/// and Alt Gr put right for that moment; for any other an unused key is made to carry it. The session's thread. The
/// destructor lets go of every key and leaves the layout as it was.
class XKeyboard {
 public:
  /// `connection` must outlive this.
  explicit XKeyboard(const XConnection& connection);
  ~XKeyboard();
  XKeyboard(const XKeyboard&) = delete;
  XKeyboard& operator=(const XKeyboard&) = delete;

  void handle(const XEvent& event);
  /// The layout has changed: it is looked at anew before the next key.
  void forgetLayout() { stale_ = true; }
  /// An X11 keysym. A key that is down already stays so: the server repeats it by itself.
  void press(std::uint32_t keysym);
  void release(std::uint32_t keysym);

 private:
  /// A way to a symbol.
  struct Stroke {
    std::uint8_t code = 0;
    bool shift = false;
    bool third = false;  // Alt Gr
    bool free = false;   // modifiers do not matter
  };
  struct Modifiers {
    bool shift = false, third = false, caps = false, numbers = false;
  };

  void load();
  void loadModifiers();
  [[nodiscard]] std::span<const std::uint32_t> symbolsOf(int code) const;
  [[nodiscard]] Modifiers modifiers() const;
  [[nodiscard]] std::vector<Stroke> strokesFor(std::uint32_t keysym, const Modifiers& now) const;
  [[nodiscard]] Stroke strokeFor(std::uint32_t keysym, const Modifiers& now);
  [[nodiscard]] std::uint8_t borrow(std::uint32_t keysym);
  void remap(std::uint8_t code, std::uint32_t keysym);
  void pressWith(const Stroke& stroke, const Modifiers& now);
  [[nodiscard]] std::vector<std::uint8_t> codesDown(std::span<const std::uint8_t> codes) const;
  void fake(std::uint8_t code, bool down) const;

  const XConnection& connection_;
  int firstCode_ = 8;
  int symbolsPerCode_ = 0;
  std::vector<std::uint32_t> symbols_;
  std::vector<std::uint8_t> shiftCodes_;
  std::vector<std::uint8_t> thirdCodes_;
  std::uint16_t thirdMask_ = 0;
  std::uint16_t numbersMask_ = 0;
  bool stale_ = true;                           // the layout has changed
  std::map<std::uint32_t, std::uint8_t> down_;  // keysym to key
  std::vector<std::uint8_t> borrowed_;          // the one used last at the end
};

}  // namespace pixelflex::viewer
