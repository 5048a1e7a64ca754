#pragma once

#include <vector>

#include "calib/simulate/simulated_wall.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// A rectangle of the wall, in wall units.
struct WallRect {
  glm::dvec2 topLeft{0, 0};
  glm::dvec2 bottomRight{0, 0};
};

/// The bounding box of what all projectors light; the screen when none reaches it.
[[nodiscard]] WallRect litRect(const SimulatedWall& wall);

/// What each projector shows on a wall that was aimed by hand and never calibrated: `desktop` is laid over `rect` and
/// each projector gets its nominal share, an upright rectangle around the middle of what it lights at its mean scale,
/// without warp or blend. Black beyond the desktop. `desktop` has one, three or four channels (alpha is ignored).
[[nodiscard]] std::vector<devices::Image8> handAimedFrames(const SimulatedWall& wall, const devices::Image8& desktop,
                                                           const WallRect& rect);

}  // namespace pixelflex::calib
