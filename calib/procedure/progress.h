#pragma once

#include <string>

namespace pixelflex::calib {

/// Where a long calculation tells how far it is. Called from the thread that runs it.
class Progress {
 public:
  Progress() = default;
  virtual ~Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  virtual void beginStep(const std::string& step) = 0;
  /// `done` of `total` (0: unknown) pieces of the step.
  virtual void advance(int done, int total, const std::string& what) = 0;
  virtual void endStep(const std::string& result) = 0;
  /// Something that a person should know; the calculation goes on.
  virtual void warn(const std::string& message) = 0;
};

}  // namespace pixelflex::calib
