#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "calib/geometry/homography.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// How an ideal image (of a camera or a projector, lens apart) and the wall's coordinates belong together: a homography
/// on a plane; on a bent screen the projection of its cylinder (see Bend).
class ScreenView {
 public:
  ScreenView() = default;  // the identity
  explicit ScreenView(const Homography& imageFromWall, const std::optional<Bend>& bend = std::nullopt);
  /// The undistorted camera's.
  explicit ScreenView(const SurfaceFit& surface);

  [[nodiscard]] glm::dvec2 imageFromWall(glm::dvec2 pointInWall) const;

  /// None where the ray misses the bent screen. Of the two places where it meets the cylinder, the one nearer to the
  /// apex: from inside and from outside that is the screen, the other its missing other half. On a plane always some
  /// point, possibly behind the viewer; see weight().
  [[nodiscard]] std::optional<glm::dvec2> wallFromImage(glm::dvec2 pointInImage) const;

  /// The third homogeneous coordinate of a wall point's image: of one sign before the viewer, of the other behind it.
  [[nodiscard]] double weight(glm::dvec2 pointInWall) const;

  /// The homography of the plane that touches the screen at a wall point, in wall coordinates.
  [[nodiscard]] Homography imageFromTangent(glm::dvec2 pointInWall) const;

 private:
  [[nodiscard]] glm::dvec3 project(glm::dvec2 pointInWall) const;
  [[nodiscard]] glm::dvec3 column(int index) const;
  [[nodiscard]] std::optional<glm::dvec2> meetCylinder(glm::dvec2 pointInImage) const;

  Homography imageFromWall_;
  Homography wallFromImage_;  // of the plane
  std::optional<Bend> bend_;
};

}  // namespace pixelflex::calib
