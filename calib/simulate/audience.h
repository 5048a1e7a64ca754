#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "calib/simulate/light_map.h"
#include "calib/simulate/stage.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The light that comes from a rectangle of the wall, straight on. Where every projector's light falls is worked out
/// once. Keeps a reference: the stage must outlive it.
class AudienceLight {
 public:
  AudienceLight(const Stage& stage, glm::dvec2 topLeft, glm::dvec2 bottomRight, devices::Size size);
  [[nodiscard]] bool looksAt(glm::dvec2 topLeft, glm::dvec2 bottomRight, devices::Size size) const;
  /// SimulatedWall::audienceLight.
  [[nodiscard]] devices::ImageF of(const std::vector<devices::Image8>& frames) const;

 private:
  const Stage& stage_;
  glm::dvec2 topLeft_;
  glm::dvec2 bottomRight_;
  devices::Size size_;
  std::vector<LightMap> maps_;  // one a projector
};

/// The same light as a picture: SimulatedWall::audience.
[[nodiscard]] devices::Image8 developAudience(const Stage& stage, const devices::ImageF& light, glm::dvec2 topLeft,
                                              glm::dvec2 bottomRight, double white);

}  // namespace pixelflex::calib
