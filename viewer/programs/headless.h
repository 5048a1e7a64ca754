#pragma once

#include "viewer/plan/wall_plan.h"
#include "viewer/programs/view_options.h"

namespace pixelflex::viewer {

/// Shows the wall in no window: until the screenshot is written, or until SIGINT, SIGTERM or SIGHUP. Returns the exit
/// status.
int runHeadless(const ViewOptions& options, const WallPlan& wall);

/// DIR/<projector>.png, exactly what each projector is sent (16-bit PNG with the highest code as 65535 when `depth` is
/// 10), and DIR/desktop.png. Throws ImageError.
void writeScreenshot(const std::string& folder, class WallRenderer& renderer, int depth);

}  // namespace pixelflex::viewer
