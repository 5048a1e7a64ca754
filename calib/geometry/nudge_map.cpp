#include "calib/geometry/nudge_map.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "calib/geometry/footprint.h"

namespace pixelflex::calib {
namespace {

/// The map of the unit square to a convex quadrilateral (Heckbert 1989, section 2.2.3).
Homography quadFromSquare(const std::array<glm::dvec2, 4>& q) {
  const glm::dvec2 d1 = q[1] - q[2];
  const glm::dvec2 d2 = q[3] - q[2];
  const glm::dvec2 sum = q[0] - q[1] + q[2] - q[3];
  const double det = d1.x * d2.y - d2.x * d1.y;
  const double g = (sum.x * d2.y - d2.x * sum.y) / det;
  const double h = (d1.x * sum.y - sum.x * d1.y) / det;
  return Homography({q[1].x - q[0].x + g * q[1].x, q[3].x - q[0].x + h * q[3].x, q[0].x, q[1].y - q[0].y + g * q[1].y,
                     q[3].y - q[0].y + h * q[3].y, q[0].y, g, h, 1});
}

void requireConvex(const std::array<glm::dvec2, 4>& q) {
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec2 u = q[(i + 1) % 4] - q[i];
    const glm::dvec2 v = q[(i + 2) % 4] - q[(i + 1) % 4];
    if (!(u.x * v.y - u.y * v.x > 0)) throw GeometryError("the nudged corners no longer form a convex frame");
  }
}

}  // namespace

Homography nudgedFromMeasured(const Nudge& nudge, devices::Size resolution) {
  const double w = resolution.width;
  const double h = resolution.height;
  std::array<glm::dvec2, 4> corners = {{{0, 0}, {w, 0}, {w, h}, {0, h}}};
  for (std::size_t i = 0; i < 4; ++i) corners[i] += nudge.corners[i];
  requireConvex(corners);
  const Homography bent = quadFromSquare(corners) * Homography::scaling({1 / w, 1 / h});
  const double angle = nudge.roll * std::numbers::pi / 180;
  const Homography rolled({std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle), 0, 0, 0, 1});
  const glm::dvec2 middle{w / 2, h / 2};
  return Homography::translation(middle + nudge.shift) * rolled * Homography::translation(-middle) * bent;
}

}  // namespace pixelflex::calib
