#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

namespace pixelflex::calib {

/// A camera pixel and the projector point that lights it.
struct DensePair {
  glm::dvec2 pointInProjector{0, 0};
  glm::dvec2 pointInUndistorted{0, 0};
};

/// The map from projector to camera around one projector point.
struct LocalMap {
  glm::dvec2 pointInUndistorted{0, 0};  // where the point is seen
  glm::dvec2 byX{0, 0};                 // how that moves with the projector's x and y
  glm::dvec2 byY{0, 0};
};

/// A quadratic through the pairs (which lie within about `reach` projector pixels of the point), by least squares with
/// outliers left out until none is found. None when too few remain or they say too little about the point itself.
[[nodiscard]] std::optional<LocalMap> fitAround(glm::dvec2 pointInProjector, double reach,
                                                std::vector<DensePair> pairs);

}  // namespace pixelflex::calib
