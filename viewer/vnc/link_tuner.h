#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "viewer/vnc/link.h"

namespace pixelflex::viewer {

/// Chooses settings for a connection by what it carries: at once by the first picture, later in steps, down when two
/// measurements in a row say so and up more slowly, so that it does not swing. No thread and no clock of its own.
class LinkTuner {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `firstRoundTrip`: of the connection's own handshake. One that takes long begins half way down.
  explicit LinkTuner(std::chrono::nanoseconds firstRoundTrip);

  [[nodiscard]] LinkSettings settings() const;
  /// While so many bytes came nothing else was waited for. True when settings() are others now.
  [[nodiscard]] bool received(std::uint64_t bytes, std::chrono::nanoseconds waiting, Time now);
  /// The shortest way to the server and back so far. Below two milliseconds a low rate is the server's own.
  void setRoundTrip(std::chrono::nanoseconds time) { roundTrip_ = time; }
  /// Bits per second, of the last measurement; zero before the first.
  [[nodiscard]] double rate() const { return rate_; }

 private:
  [[nodiscard]] std::size_t stepFor(double rate) const;
  [[nodiscard]] bool judge(Time now);
  [[nodiscard]] bool rise(Time now);

  std::size_t step_ = 0;
  std::optional<std::chrono::nanoseconds> roundTrip_;
  std::uint64_t bytes_ = 0;  // of the measurement that goes on
  std::chrono::nanoseconds waiting_{0};
  double rate_ = 0;
  bool judged_ = false;
  int slow_ = 0;  // measurements in a row that ask for a lower step
  int fast_ = 0;
  Time changed_;
};

}  // namespace pixelflex::viewer
