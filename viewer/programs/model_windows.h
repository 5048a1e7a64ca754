#pragma once

#include <memory>

#include "viewer/plan/wall_plan.h"
#include "viewer/programs/model_options.h"

namespace pixelflex::viewer {

/// Shows the model in windows on the projectors' outputs, in a window of the room for simulated ones, and in one of the
/// whole desktop when asked for or when there is no other, until somebody ends it. A new calibration of the same
/// projectors is taken over. Main thread, and there is no other yet. Returns the exit status.
int runModelWindows(const ModelCommand& command, std::shared_ptr<const WallPlan> wall, Scene scene);

}  // namespace pixelflex::viewer
