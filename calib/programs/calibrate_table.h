#pragma once

#include <string>
#include <vector>

#include "calib/procedure/drift_check.h"
#include "calib/procedure/verdicts.h"

namespace pixelflex::calib {

/// The table that ends `pixelflex calibrate`: a line a projector, then camera, surface, display and seams, and after it
/// the verdict with a line for everything that is not good.
[[nodiscard]] std::string formatTable(const Wall& wall, const Calibration& calibration, const Summary& summary);

/// The table of `pixelflex calibrate --check`.
[[nodiscard]] std::string formatDrifts(const std::vector<ProjectorDrift>& drifts);

}  // namespace pixelflex::calib
