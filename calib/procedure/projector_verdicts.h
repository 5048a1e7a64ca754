#pragma once

#include <vector>

#include "calib/procedure/verdicts.h"

namespace pixelflex::calib {

/// What is not good about one projector.
[[nodiscard]] std::vector<Finding> judgeProjector(const Calibration& calibration, const ProjectorSummary& projector);

}  // namespace pixelflex::calib
