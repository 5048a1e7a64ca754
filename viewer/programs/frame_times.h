#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace pixelflex::viewer {

/// How long a window's frames took.
class FrameTimes {
 public:
  using Clock = std::chrono::steady_clock;

  void add(Clock::time_point begun, Clock::time_point ended);
  /// "412 frames, median 6.1 ms, 99 of 100 within 14.0 ms, slowest 31.2 ms". The first frame, for which shaders are
  /// compiled, is told apart.
  [[nodiscard]] std::string text() const;

 private:
  std::vector<double> milliseconds_;
};

}  // namespace pixelflex::viewer
