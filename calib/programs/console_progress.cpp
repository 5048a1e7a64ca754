#include "calib/programs/console_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace pixelflex::calib {

using Clock = std::chrono::steady_clock;

ConsoleProgress::ConsoleProgress(bool forPrograms)
    : forPrograms_(forPrograms), terminal_(!forPrograms && isatty(STDOUT_FILENO) != 0) {}

void ConsoleProgress::beginStep(const std::string& step) {
  step_ = step;
  begun_ = Clock::now();
  drawn_ = {};
}

void ConsoleProgress::advance(int done, int total, const std::string& what) {
  constexpr auto kRedraw = std::chrono::milliseconds(100);
  if ((!terminal_ && !forPrograms_) || Clock::now() - drawn_ < kRedraw) return;
  drawn_ = Clock::now();
  if (forPrograms_) {
    fmt::print("progress {} {} {} {}\n", step_, done, total, what);
    std::fflush(stdout);
    return;
  }
  constexpr int kWidth = 30;
  const int filled = total > 0 ? kWidth * done / total : 0;
  fmt::print("\r\033[K{:<11}[{:=<{}}{: <{}}] {}/{} {}", step_, "", filled, "", kWidth - filled, done,
             total > 0 ? fmt::format("{}", total) : "?", what);
  std::fflush(stdout);
  barShown_ = true;
}

void ConsoleProgress::endStep(const std::string& result) {
  clearBar();
  const std::chrono::duration<double> taken = Clock::now() - begun_;
  fmt::print("{:<11}{:<60} {:6.1f} s\n", step_, result, taken.count());
  std::fflush(stdout);
}

void ConsoleProgress::warn(const std::string& message) {
  clearBar();
  std::fflush(stdout);
  fmt::print(stderr, "pixelflex-calibrate: warning: {}\n", message);
}

void ConsoleProgress::clearBar() {
  if (barShown_) fmt::print("\r\033[K");
  barShown_ = false;
}

}  // namespace pixelflex::calib
