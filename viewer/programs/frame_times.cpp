#include "viewer/programs/frame_times.h"

#include <fmt/format.h>

#include <algorithm>

namespace pixelflex::viewer {

void FrameTimes::add(Clock::time_point begun, Clock::time_point ended) {
  milliseconds_.push_back(std::chrono::duration<double, std::milli>(ended - begun).count());
}

std::string FrameTimes::text() const {
  if (milliseconds_.size() < 2) return "no frames";
  std::vector<double> sorted(milliseconds_.begin() + 1, milliseconds_.end());
  std::ranges::sort(sorted);
  const auto at = [&](std::size_t percent) { return sorted[(sorted.size() - 1) * percent / 100]; };
  return fmt::format("{} frames, median {:.1f} ms, 99 of 100 within {:.1f} ms, slowest {:.1f} ms; the first {:.1f} ms",
                     sorted.size(), at(50), at(99), sorted.back(), milliseconds_.front());
}

}  // namespace pixelflex::viewer
