#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// A point of the room and the projector pixel that lights it.
struct PointOnScreen {
  glm::dvec3 onScreen{0, 0, 0};
  glm::dvec2 inProjector{0, 0};
};

/// Median error, in projector pixels, of the best physical projector through the points: square pixels, one focal
/// length, any lens shift, k1 and k2. Far stiffer than fitProjector(), it tells possible screens from impossible ones.
/// `start`: a fit of the same points. None when it does not converge to a projector before the screen.
[[nodiscard]] std::optional<double> pinholeError(std::span<const PointOnScreen> points, const ProjectorModel& start);

}  // namespace pixelflex::calib
