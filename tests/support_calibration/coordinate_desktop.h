#pragma once

#include <vector>

#include "calib/simulate/rig.h"
#include "devices/image/image.h"
#include "viewer/plan/wall_plan.h"

namespace pixelflex::calib {

/// What each projector of the rig, in the rig's order, shows of a desktop of its own coordinates, drawn by the real
/// renderer: the pictures that measureRegistration() takes. Empty for projectors that were not calibrated.
[[nodiscard]] std::vector<devices::ImageF> showCoordinates(const Rig& rig, const viewer::WallPlan& wall);

}  // namespace pixelflex::calib
