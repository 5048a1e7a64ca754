#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "calib/simulate/rig.h"
#include "devices/image/image.h"
#include "viewer/plan/wall_plan.h"

namespace pixelflex::calib {

/// What the projectors of a rig, in its order, show of a desktop of four channels and of the size it was made for.
using Show = std::function<std::vector<devices::Image8>(const devices::Image8& desktop)>;

/// As the wall was calibrated, drawn by the real renderer.
[[nodiscard]] Show showMatched(const Rig& rig, const viewer::WallPlan& plan, devices::Size desktop);

/// In its right place, but without masks, matching or response: codes as an ordinary screen would get them.
[[nodiscard]] Show showUncorrected(const Rig& rig, const viewer::WallPlan& plan, devices::Size desktop);

/// By the report's method (5.2, 6.1) as hardware of its time did it: desktop in eight bits of light, filtered linearly;
/// masks of equation 7 with the smallest distance to an edge, in eight bits; the product in eight bits; then a table of
/// 256 codes straight from the readings in `folder`/readings. No matching. Throws std::runtime_error without readings.
[[nodiscard]] Show showAsInReport(const Rig& rig, const viewer::WallPlan& plan, devices::Size desktop,
                                  const std::filesystem::path& folder);

}  // namespace pixelflex::calib
