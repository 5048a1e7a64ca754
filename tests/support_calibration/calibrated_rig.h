#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/procedure/procedure.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {

/// Progress that remembers what was warned of.
class RecordedProgress : public Progress {
 public:
  void beginStep(const std::string&) override {}
  void advance(int, int, const std::string&) override {}
  void endStep(const std::string&) override {}
  void warn(const std::string& message) override { warnings.push_back(message); }
  std::vector<std::string> warnings;
};

/// A rig's wall calibrated through its camera, stored in `folder` like by `pixelflex new --rig` and `calibrate`.
struct CalibratedRig {
  Wall wall;
  Calibration calibration;
  std::vector<std::string> warnings;
};
[[nodiscard]] CalibratedRig calibrateRig(SimulatedWall& room, const std::filesystem::path& folder,
                                         std::optional<Method> method = std::nullopt, const Blend& blend = {});

}  // namespace pixelflex::calib
