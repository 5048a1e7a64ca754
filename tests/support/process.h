#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pixelflex::testing {

struct ProcessOptions {
  /// "NAME=value", added to this process's environment.
  std::vector<std::string> environment;
  /// Both output streams go here; empty: nowhere.
  std::filesystem::path log;
  /// This descriptor is open in the child under the same number.
  int inheritedFd = -1;
};

/// A program running beside the test, in a process group of its own. The destructor ends the group (SIGTERM, then
/// SIGKILL); if the thread that made it ends before, for whatever reason, the kernel kills the program.
class Process {
 public:
  /// `command` is the program, looked up in PATH, and its arguments. Throws std::runtime_error if it cannot be started.
  explicit Process(const std::vector<std::string>& command, const ProcessOptions& options = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  /// The exit status (128 + N when signal N ended it), or nothing when it still runs after `timeout`.
  std::optional<int> wait(std::chrono::milliseconds timeout);
  [[nodiscard]] bool running() { return !wait(std::chrono::milliseconds(0)).has_value(); }
  /// To the whole group.
  void signal(int number) const;

 private:
  pid_t pid_ = -1;
  std::optional<int> status_;
};

struct Output {
  int status = 0;
  std::string text;  // standard output and standard error together
};

/// Runs a program to its end. Throws std::runtime_error when it takes longer than `timeout`.
[[nodiscard]] Output run(const std::vector<std::string>& command, const std::vector<std::string>& environment = {},
                         std::chrono::milliseconds timeout = std::chrono::seconds(60));

}  // namespace pixelflex::testing
