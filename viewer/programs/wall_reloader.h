#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "viewer/plan/wall_plan.h"

namespace pixelflex::viewer {

/// Which wall is watched, and for what.
struct WatchedWall {
  std::string program;  // that tells of it
  std::string folder;
  std::vector<std::string> projectors;  // empty: all
  FitOptions fit;
  bool planned = true;  // false: without plans for a desktop
};

/// A calibration that has taken another's place while the wall is shown, ready to be drawn.
struct ReloadedWall {
  std::shared_ptr<const WallPlan> wall;
  devices::Size desktop;  // that the plans are for
  std::vector<OutputPlan> plans;
};

/// Watches a wall's folder from a thread of its own, and reads and plans a new calibration there. One that cannot be
/// read, or has other projectors than the one that is shown, is left alone with a message on stderr.
class WallReloader {
 public:
  /// `wake` is called from the thread when there is a new wall. `shown` is read in
  /// the constructor only. A folder that cannot be watched is none.
  WallReloader(WatchedWall watched, const WallPlan& shown, std::function<void()> wake);
  ~WallReloader();
  WallReloader(const WallReloader&) = delete;
  WallReloader& operator=(const WallReloader&) = delete;

  /// The size to plan for; any thread.
  void setDesktop(devices::Size desktop);
  /// The newest wall since the last call.
  [[nodiscard]] std::optional<ReloadedWall> take();

 private:
  struct Screen {
    std::string name;
    devices::Size resolution;
    bool operator==(const Screen&) const = default;
  };
  static std::vector<Screen> screensOf(const WallPlan& wall);
  void run(const std::stop_token& stop);
  [[nodiscard]] bool waitForChange(int timeout) const;
  void reload();

  const WatchedWall watched_;
  const std::vector<Screen> screens_;
  const std::function<void()> wake_;
  int watch_ = -1;
  int stopped_ = -1;
  std::mutex mutex_;  // guards what follows
  devices::Size desktop_;
  std::optional<ReloadedWall> ready_;
  std::jthread thread_;
};

}  // namespace pixelflex::viewer
