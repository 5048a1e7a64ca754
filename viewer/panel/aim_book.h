#pragma once

#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/control/wall_snapshot.h"
#include "viewer/panel/mirror_aim.h"

namespace pixelflex::viewer {

/// What is known about how each mirror aims: from presets, and from calibrations while the panel runs. Main thread;
/// files are read on another.
class AimBook {
 public:
  explicit AimBook(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Every frame.
  void update(const WallSnapshot& wall);
  /// None without a mirror whose counts are known, or without a calibration.
  [[nodiscard]] std::optional<MirrorAim> aimOf(const WallSnapshot& wall, const std::string& projector) const;

 private:
  using Poses = std::map<std::string, std::vector<AimPose>>;
  void notePoses(const WallSnapshot& wall);

  std::filesystem::path folder_;
  std::string presets_;  // names and times of those that were read
  std::shared_ptr<const calib::Calibration> calibration_;
  std::future<Poses> reading_;
  Poses ofPresets_;
  Poses seen_;
};

}  // namespace pixelflex::viewer
