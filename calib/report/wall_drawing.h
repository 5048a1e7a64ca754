#pragma once

#include <string>

#include "calib/procedure/summary.h"

namespace pixelflex::calib {

/// The wall as the audience sees it: footprints with names, the display with its desktop's size, fiducials, holes.
/// Empty when nothing is calibrated.
[[nodiscard]] std::string drawWall(const Wall& wall, const Calibration& calibration, const Summary& summary);

/// Projector pixels per desktop pixel all over the display, with what to make of it. Empty without a display.
[[nodiscard]] std::string drawWallDensity(const Wall& wall, const Calibration& calibration, const Summary& summary);

}  // namespace pixelflex::calib
