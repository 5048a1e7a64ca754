#pragma once

#include <string>
#include <vector>

#include "calib/geometry/footprint.h"
#include "calib/store/calibration.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// One projector's line of the result.
struct ProjectorSummary {
  std::string name;
  bool calibrated = false;
  FitQuality quality;
  double density = 0;                   // projector pixels per wall unit
  double overlapPercent = 0;            // of its footprint, lit by others as well
  double displayPercent = 0;            // of its footprint, inside the display
  std::vector<std::string> neighbours;  // projectors it overlaps
  Outline outline;                      // footprint on the wall
  std::string note;                     // what a person should know, or empty
};

/// What a calibration amounts to, computed from the store alone: for the table and the report.
struct Summary {
  std::vector<ProjectorSummary> projectors;  // in the wall's order
  LitArea lit;
};

[[nodiscard]] Summary summarise(const Wall& wall, const Calibration& calibration);

}  // namespace pixelflex::calib
