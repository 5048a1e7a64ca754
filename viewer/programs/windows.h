#pragma once

#include "viewer/plan/wall_plan.h"
#include "viewer/programs/view_options.h"

namespace pixelflex::viewer {

/// Shows the wall in windows: a borderless one for each projector at its monitor or position, or one window of the room
/// for a simulated wall. Until a window is closed, Ctrl+Alt+Q is pressed, or SIGINT or SIGTERM. Returns the exit
/// status.
int runWindows(const ViewOptions& options, const WallPlan& wall);

}  // namespace pixelflex::viewer
