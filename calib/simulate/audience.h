#pragma once

#include <vector>

#include "calib/simulate/stage.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// What the audience sees: SimulatedWall::audience for a stage.
[[nodiscard]] devices::Image8 composeAudience(const Stage& stage, const std::vector<devices::Image8>& frames,
                                              glm::dvec2 topLeft, glm::dvec2 bottomRight, devices::Size size,
                                              double white);

}  // namespace pixelflex::calib
