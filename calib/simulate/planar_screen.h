#pragma once

#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {

/// The plane z = 0 of the room; wall coordinates are the room's x and y.
class PlanarScreen final : public Screen {
 public:
  [[nodiscard]] std::optional<glm::dvec3> hit(glm::dvec3 origin, glm::dvec3 direction) const override;
  [[nodiscard]] glm::dvec2 wallFromRoom(glm::dvec3 point) const override;
  [[nodiscard]] glm::dvec3 roomFromWall(glm::dvec2 pointInWall) const override;
  [[nodiscard]] glm::dvec3 normal(glm::dvec2 pointInWall) const override;
  [[nodiscard]] bool isVisible(glm::dvec3 from, glm::dvec2 pointInWall) const override;
};

}  // namespace pixelflex::calib
