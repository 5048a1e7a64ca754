#pragma once

#include "viewer/renderer/output_plan.h"

namespace pixelflex::viewer {

/// The whole desktop scaled into one frame, named "control", that an operator's screen can hold: never larger than the
/// desktop, without the projectors' light.
[[nodiscard]] OutputPlan overviewOf(devices::Size desktop);

}  // namespace pixelflex::viewer
