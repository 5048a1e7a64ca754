#pragma once

#include <string>

#include "calib/procedure/summary.h"

namespace pixelflex::calib {

/// The table that ends `pixelflex calibrate`: a line a projector, then camera, surface and display.
[[nodiscard]] std::string formatTable(const Wall& wall, const Calibration& calibration, const Summary& summary);

}  // namespace pixelflex::calib
