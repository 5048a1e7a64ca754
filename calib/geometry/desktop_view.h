#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "calib/geometry/homography.h"
#include "calib/geometry/projector_mapping.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

struct MeshVertex {
  glm::dvec2 pointInProjector{0, 0};
  glm::dvec2 pointInDesktop{0, 0};
  double weight = 1;  // projective: interpolate pointInDesktop * weight and weight, then divide
};

/// Wall to desktop pixels: the display rectangle stretched over its resolution.
[[nodiscard]] Homography desktopFromWall(const Display& display);

/// The desktop as one projector sees it, and how well straight drawing between vertices follows it.
class DesktopView {
 public:
  /// The mapping must outlive this.
  DesktopView(const ProjectorMapping& mapping, const Display& display);

  /// None where the frame's ray misses the wall.
  [[nodiscard]] std::optional<glm::dvec2> desktopFromProjector(glm::dvec2 pointInProjector) const;
  /// A point within a twentieth of a pixel of the frame's border is put on it. Throws GeometryError where the lens
  /// model has no such point.
  [[nodiscard]] glm::dvec2 projectorFromDesktop(glm::dvec2 pointInDesktop) const;
  [[nodiscard]] MeshVertex vertex(glm::dvec2 pointInProjector, glm::dvec2 pointInDesktop) const;

  /// Whether an edge drawn straight in the frame shows its middle where it belongs, to kTolerance.
  [[nodiscard]] bool followsInFrame(const MeshVertex& a, const MeshVertex& b) const;
  /// The same of an edge that is straight on the desktop.
  [[nodiscard]] bool followsOnDesktop(const MeshVertex& a, const MeshVertex& b) const;
  /// The same of both diagonals of a cell of the frame; true as well where the cell misses the display or the wall.
  [[nodiscard]] bool followsInCell(glm::dvec2 low, glm::dvec2 size) const;

  /// Desktop or projector pixels.
  static constexpr double kTolerance = 0.005;

 private:
  const ProjectorMapping& mapping_;
  devices::Size desktop_;
  Homography desktopFromWall_;
  Homography wallFromDesktop_;
  Homography flatDesktopFromProjector_;
  double weightInMiddle_;
};

}  // namespace pixelflex::calib
