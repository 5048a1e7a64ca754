#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pixelflex::viewer {

struct ChildOptions {
  std::map<std::string, std::string> environment;  // added to this process's own; empty value: taken out of it
  std::filesystem::path log;                       // both output streams; empty: where this process's go
  int inheritedFd = -1;                            // open in the child under the same number
};

/// The processes that this one has started, with all that they start themselves: nobody outlives it. SIGINT, SIGTERM
/// and SIGHUP (unless that is ignored, as nohup does) are noticed in wait() and nowhere else. One at a time, in a
/// process of one thread.
class Household {
 public:
  Household();
  ~Household();
  Household(const Household&) = delete;
  Household& operator=(const Household&) = delete;

  /// In a process group of its own, so that Ctrl+C in a terminal reaches this process alone. Throws std::runtime_error
  /// when the program cannot be run.
  pid_t start(std::vector<std::string> command, const ChildOptions& options = {});

  /// What woke wait(): a child that ended, else a signal to quit, else nothing within the time.
  struct Event {
    bool quit = false;
    std::optional<pid_t> ended;
  };
  /// Until one of them ends, a signal comes, `readable` (if any) can be read, or time is up; no timeout: for ever.
  Event wait(std::optional<std::chrono::milliseconds> timeout, int readable = -1);
  /// Once it has ended: its exit status, 128 + N when signal N ended it.
  [[nodiscard]] std::optional<int> statusOf(pid_t child) const;

  /// SIGTERM to its group, and SIGKILL when it does not end.
  void end(pid_t child);

 private:
  void reap();
  void endTheRest();

  int signals_ = -1;
  std::map<pid_t, int> statuses_;
  std::vector<pid_t> reported_;
};

}  // namespace pixelflex::viewer
