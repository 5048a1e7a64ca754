#pragma once

#include <chrono>
#include <cstdint>

namespace pixelflex::viewer {

/// Notices that a Ctrl key was tapped twice in quick succession with nothing else in between: "where is the pointer?".
class ControlTaps {
 public:
  using Clock = std::chrono::steady_clock;

  /// True when this is the end of the second tap.
  bool key(std::uint32_t keysym, bool pressed, Clock::time_point now);
  /// A button or the wheel was used: Ctrl meant that.
  void forget() { strokes_ = 0; }

 private:
  int strokes_ = 0;  // down, up, down
  std::uint32_t keysym_ = 0;
  Clock::time_point begin_;
};

}  // namespace pixelflex::viewer
