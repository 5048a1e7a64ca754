#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "viewer/control/console_board.h"

namespace pixelflex::viewer {

/// Puts a wall's calibration and presets on a console's board, again whenever their files have changed. On a thread of
/// its own.
class WallWatch {
 public:
  /// `board` must outlive it.
  WallWatch(ConsoleBoard& board, std::filesystem::path folder, std::chrono::milliseconds every);
  WallWatch(const WallWatch&) = delete;
  WallWatch& operator=(const WallWatch&) = delete;

  /// Now rather than when its time has come.
  void lookAgain();

 private:
  void watch(const std::stop_token& stop);
  void look();
  void readCalibration();
  [[nodiscard]] PresetInfo readPreset(const std::string& name) const;

  ConsoleBoard& board_;
  std::filesystem::path folder_;
  std::chrono::milliseconds every_;
  std::string calibrationStamp_;  // of the thread
  std::string presetStamp_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  bool look_ = true;
  std::jthread thread_;
};

}  // namespace pixelflex::viewer
