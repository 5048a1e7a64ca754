#include "calib/simulate/planar_screen.h"

namespace pixelflex::calib {

std::optional<glm::dvec3> PlanarScreen::hit(glm::dvec3 origin, glm::dvec3 direction) const {
  if (origin.z >= 0 || direction.z <= 1e-9) return std::nullopt;
  return origin - direction * (origin.z / direction.z);
}

glm::dvec2 PlanarScreen::wallFromRoom(glm::dvec3 point) const {
  return {point.x, point.y};
}

glm::dvec3 PlanarScreen::roomFromWall(glm::dvec2 pointInWall) const {
  return {pointInWall, 0};
}

glm::dvec3 PlanarScreen::normal(glm::dvec2 /*pointInWall*/) const {
  return {0, 0, -1};
}

bool PlanarScreen::isVisible(glm::dvec3 from, glm::dvec2 /*pointInWall*/) const {
  return from.z < 0;
}

}  // namespace pixelflex::calib
