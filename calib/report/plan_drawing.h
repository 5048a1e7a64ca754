#pragma once

#include <string>

#include "calib/procedure/summary.h"

namespace pixelflex::calib {

/// A bent screen from above, the audience below it: its arc, and what each projector lights of it. Empty on a plane.
[[nodiscard]] std::string drawPlan(const Calibration& calibration, const Summary& summary);

}  // namespace pixelflex::calib
