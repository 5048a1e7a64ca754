#pragma once

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "calib/simulate/rig.h"

namespace pixelflex::calib {

struct WallBounds {
  glm::dvec2 low{1e12, 1e12};
  glm::dvec2 high{-1e12, -1e12};
  void include(glm::dvec2 point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
};

/// Points along the outlines of all frames on the wall.
[[nodiscard]] std::vector<glm::dvec2> frameOutlines(const Rig& rig);

/// A wide lens of k1 about -0.1 whose principal point is a little off the middle.
[[nodiscard]] Optics wideLens(devices::Size size);

/// Gives the rig's camera that lens and an oblique place (yaw 6, pitch 5 degrees) from which it sees
/// all frames and markers, as large as a border of 40 pixels allows.
void placeCamera(Rig& rig);

}  // namespace pixelflex::calib
