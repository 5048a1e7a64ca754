#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "viewer/vnc/screen_layout.h"
#include "viewer/vnc/session_event.h"

namespace pixelflex::viewer {

struct PointerInput {
  int x = 0, y = 0;
  std::uint16_t buttons = 0;  // one bit each, X button 1 lowest
  bool operator==(const PointerInput&) const = default;
};

struct KeyInput {
  std::uint32_t keysym = 0;
  bool down = false;
  bool operator==(const KeyInput&) const = default;
};

struct ClipboardInput {
  std::string text;  // UTF-8
  Selection selection = Selection::kClipboard;
  bool operator==(const ClipboardInput&) const = default;
};

struct LayoutInput {
  ScreenLayout layout;
  bool operator==(const LayoutInput&) const = default;
};

using Input = std::variant<PointerInput, KeyInput, ClipboardInput, LayoutInput>;

/// Input on its way to the server, in order. A motion replaces a motion just before it, so that a slow link does
/// not lag behind the hand; where a button goes down or up is never lost. Only the newest clipboard of a kind waits.
/// Not thread-safe.
class InputQueue {
 public:
  void add(Input input);
  [[nodiscard]] std::vector<Input> takeAll() { return std::exchange(waiting_, {}); }

 private:
  void addPointer(const PointerInput& pointer);

  std::vector<Input> waiting_;
  std::uint16_t buttons_ = 0;  // of the last pointer input, taken or not
  bool lastIsMotion_ = false;  // of waiting_
};

}  // namespace pixelflex::viewer
