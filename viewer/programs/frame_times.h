#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace pixelflex::viewer {

/// How long a window's frames took.
class FrameTimes {
 public:
  /// Of the thread that calls.
  void begin();
  void end();
  /// "412 frames, median 6.1 ms, 99 of 100 within 14.0 ms, slowest 31.2 ms, of which the thread itself computed at most
  /// 4.0 ms". The first frame, for which shaders are compiled, is told apart.
  [[nodiscard]] std::string text() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::vector<double> milliseconds_;
  double mostComputed_ = 0;  // but for the first
  Clock::time_point begun_;
  double computedBefore_ = 0;
};

}  // namespace pixelflex::viewer
