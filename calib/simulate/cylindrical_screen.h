#pragma once

#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {

/// Part of a cylinder with a vertical axis that touches the plane z = 0 where wall x is `apex`. Wall coordinates are
/// the unrolled screen: x along the arc, y down. It ends 80 degrees to either side of the apex.
class CylindricalScreen final : public Screen {
 public:
  /// `radius` in wall units, not 0: positive is hollow towards the audience, negative bulges towards it.
  CylindricalScreen(double radius, double apex);

  /// The audience's side only: a ray that meets the back first goes no further.
  [[nodiscard]] std::optional<glm::dvec3> hit(glm::dvec3 origin, glm::dvec3 direction) const override;
  [[nodiscard]] glm::dvec2 wallFromRoom(glm::dvec3 point) const override;
  [[nodiscard]] glm::dvec3 roomFromWall(glm::dvec2 pointInWall) const override;
  [[nodiscard]] glm::dvec3 normal(glm::dvec2 pointInWall) const override;
  [[nodiscard]] bool isVisible(glm::dvec3 from, glm::dvec2 pointInWall) const override;

 private:
  /// How far along a ray it enters and leaves the whole cylinder.
  struct Crossing {
    double enter = 0;
    double leave = 0;
  };
  [[nodiscard]] std::optional<Crossing> cross(glm::dvec3 origin, glm::dvec3 direction) const;
  [[nodiscard]] double angleOf(glm::dvec3 point) const;
  [[nodiscard]] bool isOnArc(glm::dvec3 point) const;
  [[nodiscard]] bool backIsInTheWay(const Crossing& crossing, glm::dvec3 origin, glm::dvec3 direction) const;

  double radius_;
  double apex_;
};

}  // namespace pixelflex::calib
