#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/store/calibration.h"
#include "calib/store/wall.h"
#include "viewer/plan/desktop_fit.h"
#include "viewer/plan/projector_light.h"
#include "viewer/renderer/output_plan.h"

namespace pixelflex::viewer {

/// A calibrated wall as the viewer needs it, read from the store once.
class WallPlan {
 public:
  /// `only`: names of the projectors to show; empty means all that are calibrated. Reads masks, gains, black maps and
  /// responses from `folder`, with two threads. Throws PlanError, StoreError, ImageError, ResponseError.
  WallPlan(const std::filesystem::path& folder, calib::Wall wall, calib::Calibration calibration,
           const std::vector<std::string>& only, const FitOptions& fit = {});

  /// The desktop that the wall was calibrated for.
  [[nodiscard]] devices::Size desktop() const { return display_.resolution; }
  [[nodiscard]] const std::vector<const calib::ProjectorCalibration*>& projectors() const { return projectors_; }
  [[nodiscard]] const calib::Wall& wall() const { return wall_; }
  [[nodiscard]] const calib::Calibration& calibration() const { return calibration_; }
  /// The display rectangle and the desktop that it was calibrated for.
  [[nodiscard]] const calib::Display& display() const { return display_; }

  /// Where a desktop of this size is shown.
  [[nodiscard]] Placement placementOf(devices::Size desktop) const;
  /// The rectangle of the wall that a desktop of this size would take as a whole, larger than display() where only a
  /// region is shown.
  [[nodiscard]] calib::Display displayOf(devices::Size desktop) const;

  /// One plan for each of projectors(), for a desktop of this size, placed within the display rectangle. Flat screens
  /// show their part one to one unless it is scaled. Uses two threads.
  [[nodiscard]] std::vector<OutputPlan> outputsFor(devices::Size desktop) const;

  /// The plan of one of projectors() without a mesh.
  [[nodiscard]] OutputPlan lightFor(std::size_t index, devices::Size desktop) const;
  /// The plan of one of projectors(), not a flat screen, for a picture of just this part of the wall.
  [[nodiscard]] OutputPlan outputFor(std::size_t index, const calib::Display& part) const;

 private:
  [[nodiscard]] OutputPlan outputFor(std::size_t index, devices::Size desktop) const;

  calib::Wall wall_;
  calib::Calibration calibration_;
  calib::Display display_;
  FitOptions fit_;
  std::vector<const calib::ProjectorCalibration*> projectors_;
  std::vector<ProjectorLight> light_;  // one for each of projectors_
};

}  // namespace pixelflex::viewer
