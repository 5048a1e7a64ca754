#pragma once

#include <cstddef>
#include <filesystem>

#include "calib/photometric/response_curve.h"
#include "calib/simulate/simulated_wall.h"
#include "tests/support_calibration/calibrated_rig.h"

namespace pixelflex::calib {

/// A rig's wall whose geometry is calibrated once, to match its light in one way after another from the same
/// photographs.
class LightSession {
 public:
  /// Calibrates all into `folder`, with blobs. The blend must match light, so that all is photographed that this needs.
  /// The room must outlive this. Throws std::runtime_error unless every projector could be calibrated.
  LightSession(SimulatedWall& room, std::filesystem::path folder, const Blend& blend);

  /// Blend and response again. Files of the light before are overwritten: read them first.
  void match(const Blend& blend);

  /// What the camera finds of a projector's response, photographed now. Throws ProcedureError where it finds nothing.
  [[nodiscard]] ResponseCurve responseByCamera(std::size_t projector);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const Wall& wall() const { return rig_.wall; }
  [[nodiscard]] const Calibration& calibration() const { return rig_.calibration; }

 private:
  SimulatedWall& room_;
  std::filesystem::path folder_;
  CalibratedRig rig_;
};

}  // namespace pixelflex::calib
