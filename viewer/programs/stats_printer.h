#pragma once

#include <chrono>
#include <fstream>
#include <optional>
#include <string>

#include "viewer/programs/stats_text.h"
#include "viewer/programs/wall_view.h"

namespace pixelflex::viewer {

/// `--stats`: a line on stderr each second in which something was uploaded or drawn, one each ten in which updates were
/// shown on how long they took, one when the first picture is shown, and the sums at the end. `--stats=overlay`: a
/// panel on the first projector, brought up to date each second in which updates were shown. `--stats-json`: the same
/// with the first picture, each ten seconds and at the end. Lines say of which display they are where there are
/// several.
class StatsPrinter {
 public:
  /// Throws ViewError when the file cannot be written.
  explicit StatsPrinter(const ViewOptions& options);

  /// When the loop should wake for the next line at the latest.
  [[nodiscard]] WallView::Clock::time_point due() const;
  void printIfDue(WallView& view);
  /// What the view has drawn is shown: tells of the first picture.
  void shown(const WallView& view);
  void printTotal(WallView& view);
  /// Shows the panel, of all that has been done so far, or takes it away.
  void toggleOverlay(WallView& view);

 private:
  using Time = WallView::Clock::time_point;
  /// A point from which on an account is given.
  struct Mark {
    Time due;
    RenderStats render;
    std::uint64_t updates = 0;
    std::uint64_t shown = 0;
  };
  [[nodiscard]] Account since(const Mark& mark, WallView& view, Time now) const;
  [[nodiscard]] static Mark markOf(WallView& view, Time due);
  void printWork(const Account& account) const;
  void printStages(const Account& account);
  void showPanel(const Account& account, WallView& view);

  bool prints_;
  bool overlays_;
  const std::string of_;  // see ViewOptions::statsOf
  std::optional<std::ofstream> json_;
  const Time started_;
  bool firstShown_ = false;
  Time begun_ = WallView::Clock::now();
  Mark second_;
  Mark tenSeconds_;
};

}  // namespace pixelflex::viewer
