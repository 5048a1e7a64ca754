#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/bench/thread_times.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {

/// What was drawn, as the viewer itself tells.
struct DrawnWork {
  double outputs = 0;
  double pixels = 0;
};

/// pixelflex-view by VNC, with its figures in a file.
class MeasuredViewer {
 public:
  MeasuredViewer(const std::string& wall, const std::string& server,
                 const std::vector<std::string>& more = {"--headless"});

  /// Seconds from its start by this process's clock to the first picture. Throws std::runtime_error.
  double waitForPicture();
  [[nodiscard]] ThreadTimes times() const { return threadTimes(process_.pid()); }
  /// Until its threads have been still for a while.
  void waitForRest() const;
  /// MiB, by the kernel's name of it.
  [[nodiscard]] double memory(const std::string& name) const;
  /// Ends it: all that it has drawn.
  [[nodiscard]] DrawnWork end();

 private:
  TemporaryFolder folder_;
  std::chrono::steady_clock::time_point begun_;
  Process process_;
};

/// Throws std::runtime_error when it does not come true for minutes.
void waitUntil(const std::function<bool()>& done, const std::string& what);

}  // namespace pixelflex::testing
