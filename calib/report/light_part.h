#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "calib/procedure/summary.h"
#include "calib/report/wall_light.h"

namespace pixelflex::calib {

/// The report's part on light as a whole: evenness, what matching costs, colours, the audience's view, and luminance
/// across every overlap inside the display. All of it is computed from what was measured of each projector.
[[nodiscard]] std::string lightPart(const WallLight& light, const Calibration& calibration, const Summary& summary);

}  // namespace pixelflex::calib
