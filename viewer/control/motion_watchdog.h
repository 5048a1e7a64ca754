#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "calib/store/wall_devices.h"

namespace pixelflex::viewer {

/// A process beside this one that halts mirrors when this one dies without having said that they stand: killed, or
/// crashed. Make it before any thread is started.
class MotionWatchdog {
 public:
  /// `mirrors` are those that may be moved. Throws std::system_error.
  explicit MotionWatchdog(const std::vector<calib::WallDevice>& mirrors);
  /// Nothing moves any more.
  ~MotionWatchdog();
  MotionWatchdog(const MotionWatchdog&) = delete;
  MotionWatchdog& operator=(const MotionWatchdog&) = delete;

 private:
  int pipe_ = -1;
  pid_t child_ = -1;
};

}  // namespace pixelflex::viewer
