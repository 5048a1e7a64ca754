#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "calib/simulate/lens.h"
#include "calib/simulate/rig.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {

/// Rotation by yaw, pitch and roll (degrees): carries device axes (x right, y down, z along the optical axis) to the
/// room.
[[nodiscard]] glm::dmat3 roomFromDevice(glm::dvec3 rotation);

/// A lens at a place in the room: the optics that a projector and a camera have in common.
class PlacedOptics {
 public:
  PlacedOptics(const Pose& pose, const Optics& optics);

  [[nodiscard]] glm::dvec3 position() const { return position_; }
  [[nodiscard]] const Lens& lens() const { return lens_; }

  /// Direction in the room (not normalised) of the ray through a pixel.
  [[nodiscard]] std::optional<glm::dvec3> direction(glm::dvec2 pixel) const;
  /// Pixel of a point of the room; none behind the lens or beyond its fold.
  [[nodiscard]] std::optional<glm::dvec2> pixelFromRoom(glm::dvec3 point) const;

  [[nodiscard]] std::optional<glm::dvec2> wallFromPixel(const Screen& screen, glm::dvec2 pixel) const;
  /// None also where the screen turns its back or hides the point.
  [[nodiscard]] std::optional<glm::dvec2> pixelFromWall(const Screen& screen, glm::dvec2 pointInWall) const;

 private:
  glm::dvec3 position_;
  glm::dmat3 roomFromDevice_;
  Lens lens_;
};

}  // namespace pixelflex::calib
