#include "calib/geometry/brown_lens.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace pixelflex::calib {
namespace {

double findFoldRadius(const std::array<double, 3>& radial) {
  // The distorted radius r(1 + k1 r2 + k2 r4 + k3 r6) grows while its derivative is positive.
  const auto grows = [&](double r2) {
    return 1 + r2 * (3 * radial[0] + r2 * (5 * radial[1] + r2 * 7 * radial[2])) > 0;
  };
  constexpr double kStep = 0.01;
  constexpr double kLargestR2 = 16;  // a field of view of 152 degrees
  for (double r2 = kStep; r2 < kLargestR2; r2 += kStep) {
    if (!grows(r2)) return std::sqrt(r2 - kStep);
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

BrownLens::BrownLens(const std::array<double, 3>& radial, const std::array<double, 2>& tangential)
    : radial_(radial), tangential_(tangential), foldRadius_(findFoldRadius(radial)) {}

BrownLens::Jacobian BrownLens::jacobianAt(glm::dvec2 p) const {
  const auto& [k1, k2, k3] = radial_;
  const auto& [p1, p2] = tangential_;
  const double r2 = p.x * p.x + p.y * p.y;
  const double factor = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));  // twice d(factor)/d(r2)
  return {factor + slope * p.x * p.x + 2 * p1 * p.y + 6 * p2 * p.x, slope * p.x * p.y + 2 * p1 * p.x + 2 * p2 * p.y,
          factor + slope * p.y * p.y + 6 * p1 * p.y + 2 * p2 * p.x};
}

glm::dvec2 BrownLens::distort(glm::dvec2 ideal) const {
  glm::dvec2 out;
  distort(ideal.x, ideal.y, radial_.data(), tangential_.data(), &out.x, &out.y);
  return out;
}

std::optional<glm::dvec2> BrownLens::undistort(glm::dvec2 distorted) const {
  const double limit = foldRadius_;
  glm::dvec2 ideal = distorted;
  if (glm::length(ideal) >= limit) ideal *= 0.9 * limit / glm::length(ideal);
  for (int iteration = 0; iteration < 50; ++iteration) {
    const glm::dvec2 error = distort(ideal) - distorted;
    if (glm::length(error) < 1e-13) return ideal;
    const Jacobian j = jacobianAt(ideal);
    const double det = j.xx * j.yy - j.xy * j.xy;
    if (std::abs(det) < 1e-9) return std::nullopt;
    glm::dvec2 step{(j.yy * error.x - j.xy * error.y) / det, (j.xx * error.y - j.xy * error.x) / det};
    const double length = glm::length(step);
    if (length > 0.5) step *= 0.5 / length;
    ideal -= step;
    if (length < 1e-15) break;
    if (glm::length(ideal) > limit) return std::nullopt;
  }
  return glm::length(distort(ideal) - distorted) < 1e-9 ? std::optional(ideal) : std::nullopt;
}

}  // namespace pixelflex::calib
