#pragma once

#include "calib/store/calibration.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// Report 5.1.4: the effective display area of what the calibrated projectors light. Throws ProcedureError.
[[nodiscard]] Display measureDisplay(const Wall& wall, const Calibration& calibration);

/// Whether every point of the display is still lit.
[[nodiscard]] bool displayIsLit(const Calibration& calibration);

}  // namespace pixelflex::calib
