#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/control/wall_snapshot.h"

namespace pixelflex::viewer {

/// What is known about a wall right now, written by the threads that find it out. Thread-safe, and nobody ever holds
/// it for longer than a copy takes.
class ConsoleBoard {
 public:
  explicit ConsoleBoard(std::shared_ptr<const calib::Wall> wall, const std::vector<calib::WallDevice>& devices);

  /// The same one until something changes.
  [[nodiscard]] std::shared_ptr<const WallSnapshot> snapshot() const;

  void changeDevice(std::size_t device, const std::function<void(DeviceState& state)>& change);

  /// The number of a new job, whose command goes into the log.
  [[nodiscard]] int beginJob(ConsoleJob::Kind kind, const std::string& command);
  void changeJob(int job, const std::function<void(ConsoleJob& state)>& change);
  /// A job that failed (`error` is not empty) is logged as such.
  void endJob(int job, const std::string& error);
  [[nodiscard]] bool isRunning(ConsoleJob::Kind kind) const;

  void log(LogLine::Kind kind, std::string_view text);
  void setPresets(std::vector<PresetInfo> presets);
  void setCalibration(std::shared_ptr<const calib::Calibration> calibration, const std::string& trouble);

  static constexpr std::size_t kLogLines = 500;
  static constexpr std::size_t kEndedJobs = 40;

 private:
  void logLocked(LogLine::Kind kind, std::string_view text);
  void forgetEndedJobs();
  [[nodiscard]] ConsoleJob* jobLocked(int job);
  void changed() { ++state_.revision; }

  mutable std::mutex mutex_;
  WallSnapshot state_;
  mutable std::shared_ptr<const WallSnapshot> published_;
  int jobs_ = 0;
  std::uint64_t lines_ = 0;
};

}  // namespace pixelflex::viewer
