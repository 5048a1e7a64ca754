#pragma once

#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "viewer/programs/view_options.h"

namespace pixelflex::viewer {

/// Viewers of a wall, one for each X display, in processes of their own. One that fails is said and started again,
/// sooner at first, as long as another one runs; when a person ends one of them, or a signal this process, all end. The
/// process must have no other thread.
class ViewerProcesses {
 public:
  /// Called in the new processes.
  using View = std::function<int(const ViewOptions&)>;
  explicit ViewerProcesses(View view);
  ~ViewerProcesses();
  ViewerProcesses(const ViewerProcesses&) = delete;
  ViewerProcesses& operator=(const ViewerProcesses&) = delete;

  void add(std::string display, ViewOptions options);
  /// Until all have ended: 0 when a person ended them; with screenshots, or when they failed, the worst status. Throws
  /// ViewError, and PasswordNeeded when one of them needs one.
  int run();

 private:
  using Clock = std::chrono::steady_clock;
  struct Viewer {
    std::string display;
    ViewOptions options;
    pid_t process = -1;  // not running
    Clock::time_point begun;
    int failures = 0;                      // since it last ran for a while
    std::optional<Clock::time_point> due;  // to be started then
  };
  void start(Viewer& viewer);
  [[noreturn]] void become(const Viewer& viewer, pid_t parent);
  [[nodiscard]] bool anyRuns() const;
  [[nodiscard]] std::optional<Clock::time_point> nextDue() const;
  void waitForSignal();
  void startDue();
  void greetReturned();
  void reap();
  void ended(Viewer& viewer, int status);
  void fail(Viewer& viewer);
  void endAll();

  const View view_;
  sigset_t watched_{};
  sigset_t before_{};  // the signals that were blocked
  std::vector<Viewer> viewers_;
  bool ending_ = false;
  bool left_ = false;  // by a person
  bool passwordNeeded_ = false;
  int worst_ = 0;
};

}  // namespace pixelflex::viewer
