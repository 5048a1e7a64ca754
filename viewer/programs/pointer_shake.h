#pragma once

#include <chrono>
#include <deque>
#include <glm/vec2.hpp>

namespace pixelflex::viewer {

/// Notices that the pointer is shaken, to and fro several times in quick succession: "where is the pointer?".
class PointerShake {
 public:
  using Clock = std::chrono::steady_clock;

  /// The pointer is here now, in desktop pixels: true when it has been shaken enough, and then not before it has been
  /// shaken anew.
  bool move(glm::dvec2 position, Clock::time_point now);
  /// A button or the wheel was used: moving meant that.
  void forget() { *this = {}; }

 private:
  /// One way of the two; a stroke ends where the pointer turns.
  struct Axis {
    bool move(double position, Clock::time_point now);
    bool begun = false;
    double farthest = 0;  // of this stroke
    int direction = 0;    // of this stroke; 0 before the first
    std::deque<Clock::time_point> turns;
  };
  Axis across_;
  Axis along_;
};

}  // namespace pixelflex::viewer
