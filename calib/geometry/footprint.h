#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <stdexcept>
#include <vector>

#include "calib/geometry/projector_mapping.h"

namespace pixelflex::calib {

/// A geometric construction is impossible for these inputs; what() says why.
class GeometryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using Outline = std::vector<glm::dvec2>;  // a simple polygon, not closed by repeating its first point

inline constexpr int kOutlinePointsPerEdge = 64;

/// The wall area that a projector lights: its frame's border, the corners among its points, clockwise as the audience
/// sees an unmirrored picture. Throws GeometryError when part of the frame misses the wall.
[[nodiscard]] Outline footprint(const ProjectorMapping& mapping);

/// Signed by nothing: always positive.
[[nodiscard]] double areaOf(std::span<const glm::dvec2> outline);

/// The wall area that is lit at all (report 5.1.4: "a single unified display area").
struct LitArea {
  std::vector<Outline> islands;  // outer borders of the connected parts, the largest first
  std::vector<Outline> holes;
  double area = 0;
};
[[nodiscard]] LitArea uniteFootprints(std::span<const Outline> footprints);

/// The area lit by both.
[[nodiscard]] double overlapArea(const Outline& a, const Outline& b);

}  // namespace pixelflex::calib
