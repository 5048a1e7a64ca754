#include "viewer/programs/frame_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

namespace pixelflex::viewer {
namespace {

/// Milliseconds of this thread.
double computed() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace

void FrameTimes::begin() {
  begun_ = Clock::now();
  computedBefore_ = computed();
}

void FrameTimes::end() {
  if (!milliseconds_.empty()) mostComputed_ = std::max(mostComputed_, computed() - computedBefore_);
  milliseconds_.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begun_).count());
}

std::string FrameTimes::text() const {
  if (milliseconds_.size() < 2) return "no frames";
  std::vector<double> sorted(milliseconds_.begin() + 1, milliseconds_.end());
  std::ranges::sort(sorted);
  const auto at = [&](std::size_t percent) { return sorted[(sorted.size() - 1) * percent / 100]; };
  return fmt::format(
      "{} frames, median {:.1f} ms, 99 of 100 within {:.1f} ms, slowest {:.1f} ms, of which the thread itself computed "
      "at most {:.1f} ms; the first {:.1f} ms",
      sorted.size(), at(50), at(99), sorted.back(), mostComputed_, milliseconds_.front());
}

}  // namespace pixelflex::viewer
