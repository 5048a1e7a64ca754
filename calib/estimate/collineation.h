#pragma once

#include <glm/vec2.hpp>
#include <span>

#include "calib/estimate/intrinsics.h"
#include "calib/geometry/homography.h"

namespace pixelflex::calib {

struct PointPair {
  glm::dvec2 source{0, 0};
  glm::dvec2 target{0, 0};
};

/// The collineation C of report 5.1.2 (equations 1-6; the printed 2, 3, 4 in the third columns of F read 1): exact for
/// four pairs, least squares of the target error for more. Coordinates are normalised first, so a camera whose origin
/// lies on the wall's horizon is no special case. Throws EstimateError for fewer than four pairs or a degenerate
/// layout.
[[nodiscard]] Homography solveCollineation(std::span<const PointPair> pairs);

/// Root mean square distance, in target units, between the mapped sources and the targets.
[[nodiscard]] double rmsError(const Homography& targetFromSource, std::span<const PointPair> pairs);

}  // namespace pixelflex::calib
