#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "devices/image/size.h"

namespace pixelflex::viewer {

/// What straight drawing leaves of a projector's lens: shifts on a lattice of columns x rows nodes that is laid over
/// the frame and `kLensMargin` of it to every side. Clip coordinates of the projector, linear between nodes.
struct LensLattice {
  int columns = 0;
  int rows = 0;
  std::vector<glm::vec2> shifts;  // row by row
  [[nodiscard]] bool empty() const { return shifts.empty(); }
};
inline constexpr double kLensMargin = 0.25;

/// The 4x4 that takes a scene from the desktop's clip coordinates to a projector's (Raskar 2000): x, y and w by the
/// homography of the wall, which is taken as between the two clip planes' x and y. Depth is scaled so that within the
/// frame it stays within the clip range; at every pixel it keeps the order of the desktop's own depth. Throws
/// std::invalid_argument when the frame reaches the homography's horizon.
[[nodiscard]] glm::dmat4 depthKeeping(const glm::dmat3& projectorFromDesktop);

/// Pixels of a frame to its clip coordinates, y downwards like those.
[[nodiscard]] glm::dvec2 clipFromPixel(glm::dvec2 pixel, devices::Size frame);

}  // namespace pixelflex::viewer
