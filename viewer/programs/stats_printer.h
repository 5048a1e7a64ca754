#pragma once

#include <chrono>

#include "viewer/programs/wall_view.h"

namespace pixelflex::viewer {

/// `--stats`: a line on stderr each second in which something was uploaded or drawn, and the sum at the end.
class StatsPrinter {
 public:
  explicit StatsPrinter(bool enabled) : enabled_(enabled), begun_(WallView::Clock::now()), due_(begun_ + kPeriod) {}

  /// When the loop should wake for the next line at the latest.
  [[nodiscard]] WallView::Clock::time_point due() const;
  void printIfDue(WallView& view);
  void printTotal(WallView& view) const;

 private:
  static constexpr std::chrono::seconds kPeriod{1};
  bool enabled_;
  WallView::Clock::time_point begun_;
  WallView::Clock::time_point due_;
  RenderStats before_;
  std::uint64_t updatesBefore_ = 0;
};

}  // namespace pixelflex::viewer
