#pragma once

#include <array>

#include "calib/patterns/projected_pattern.h"
#include "devices/image/size.h"

namespace pixelflex::calib {

/// Full fields of one channel, "red", "green" and "blue": how a projector's colours differ from its neighbours'.
[[nodiscard]] std::array<ProjectedPattern, 3> colourFields(devices::Size resolution);

}  // namespace pixelflex::calib
