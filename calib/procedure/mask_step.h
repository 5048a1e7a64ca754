#pragma once

#include <vector>

#include "calib/procedure/progress.h"
#include "calib/store/calibration.h"
#include "calib/store/wall.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The alpha mask of every projector, in their order. Throws ProcedureError: left and right eyes were asked for, and a
/// projector is not one of a pair.
[[nodiscard]] std::vector<devices::Image16> paintMasks(const Blend& blend,
                                                       const std::vector<ProjectorCalibration>& projectors,
                                                       Progress& progress);

}  // namespace pixelflex::calib
