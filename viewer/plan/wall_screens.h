#pragma once

#include <vector>

#include "viewer/plan/wall_plan.h"

namespace pixelflex::viewer {

/// For each projector of the wall the part of the wall's own desktop that it shows: the box around it, halved with its
/// neighbour where both overlap. Projectors that show nothing are left out.
[[nodiscard]] std::vector<Box> screensOfProjectors(const WallPlan& wall);

}  // namespace pixelflex::viewer
