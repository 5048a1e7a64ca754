#pragma once

#include <chrono>
#include <string>

#include "calib/procedure/progress.h"

namespace pixelflex::calib {

/// Progress on a terminal: one line a step with its time, a bar while it runs; without a terminal only whole lines. For
/// programs, `forPrograms`: in the bar's stead a line "progress STEP DONE TOTAL WHAT" now and then.
class ConsoleProgress : public Progress {
 public:
  explicit ConsoleProgress(bool forPrograms);
  void beginStep(const std::string& step) override;
  void advance(int done, int total, const std::string& what) override;
  void endStep(const std::string& result) override;
  void warn(const std::string& message) override;

 private:
  void clearBar();
  bool forPrograms_;
  bool terminal_;
  bool barShown_ = false;
  std::string step_;
  std::chrono::steady_clock::time_point begun_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace pixelflex::calib
