#pragma once

#include <compare>
#include <map>
#include <vector>

#include "calib/estimate/joint_solve.h"
#include "calib/geometry/homography.h"

namespace pixelflex::calib {

/// A point of a projector's frame as the key of what is known of it.
struct PointKey {
  PointKey(std::size_t projectorIndex, glm::dvec2 pointInProjector)
      : projector(projectorIndex), x(pointInProjector.x), y(pointInProjector.y) {}
  [[nodiscard]] glm::dvec2 inProjector() const { return {x, y}; }
  auto operator<=>(const PointKey&) const = default;
  std::size_t projector;
  double x, y;
};

/// Where joint adjustment starts from: good to some pixels.
struct ChainedPlaces {
  std::vector<Homography> wallFromCamera;  // of every place, undistorted camera pixels
  std::map<PointKey, glm::dvec2> points;   // in wall units
};

/// Place after place, by homographies through the points that it shares with those before it. Throws EstimateError.
[[nodiscard]] ChainedPlaces chainPlaces(const JointProblem& problem);

}  // namespace pixelflex::calib
