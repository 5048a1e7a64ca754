#pragma once

#include <string>
#include <vector>

#include "calib/geometry/footprint.h"
#include "calib/procedure/seams.h"
#include "calib/store/calibration.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// One projector's line of the result.
struct ProjectorSummary {
  std::string name;
  bool calibrated = false;
  FitQuality quality;
  double density = 0;                   // projector pixels per wall unit
  double desktopDensity = 0;            // projector pixels per desktop pixel, mean over the frame; 0 without a display
  double overlapPercent = 0;            // of its footprint, lit by others as well
  double displayPercent = 0;            // of its footprint, inside the display
  std::vector<std::string> neighbours;  // projectors it overlaps
  Outline outline;                      // footprint on the wall
  std::string note;                     // what a person should know, or empty
};

/// What a calibration amounts to, computed from the store alone: for the table and the report.
struct Summary {
  std::vector<ProjectorSummary> projectors;  // in the wall's order
  std::vector<Seam> seams;                   // every overlap of two
  LitArea lit;
  std::vector<std::string> missingSteps;  // of `pixelflex calibrate`, that the store holds no result of
};

[[nodiscard]] Summary summarise(const Wall& wall, const Calibration& calibration);

/// Desktop pixels per wall unit.
[[nodiscard]] double desktopPixelsPerUnit(const Display& display);

}  // namespace pixelflex::calib
