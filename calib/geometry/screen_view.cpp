#include "calib/geometry/screen_view.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace pixelflex::calib {
namespace {

/// The angle of the two that solve a sin t + d cos t + c = 0 whose magnitude is smaller.
std::optional<double> smallerAngle(double a, double d, double c) {
  const double magnitude = std::hypot(a, d);
  if (!(std::abs(c) <= magnitude) || magnitude == 0) return std::nullopt;
  const double rise = std::asin(-c / magnitude);
  const double phase = std::atan2(d, a);
  const auto wrapped = [](double angle) { return std::remainder(angle, 2 * std::numbers::pi); };
  const double first = wrapped(rise - phase);
  const double second = wrapped(std::numbers::pi - rise - phase);
  return std::abs(first) <= std::abs(second) ? first : second;
}

/// With its scale, to which a bend's depth is relative.
Homography exactInverse(const std::array<double, 9>& m) {
  std::array<double, 9> inverse = Homography(m).inverse().rowMajor();
  const double determinant = m[0] * inverse[0] + m[1] * inverse[3] + m[2] * inverse[6];
  for (double& value : inverse) value /= determinant;
  return Homography(inverse);
}

}  // namespace

ScreenView::ScreenView(const Homography& imageFromWall, const std::optional<Bend>& bend)
    : imageFromWall_(imageFromWall), wallFromImage_(imageFromWall.inverse()), bend_(bend) {}

ScreenView::ScreenView(const SurfaceFit& surface)
    : imageFromWall_(exactInverse(surface.wallFromCamera)),
      wallFromImage_(surface.wallFromCamera),
      bend_(surface.bend) {}

glm::dvec3 ScreenView::column(int index) const {
  const auto& h = imageFromWall_.rowMajor();
  const auto i = static_cast<std::size_t>(index);
  return {h[i], h[3 + i], h[6 + i]};
}

glm::dvec3 ScreenView::project(glm::dvec2 w) const {
  if (!bend_) return column(0) * w.x + column(1) * w.y + column(2);
  const double t = (w.x - bend_->apex) / bend_->radius;
  const double across = bend_->apex + bend_->radius * std::sin(t);
  const double away = bend_->radius * (std::cos(t) - 1);
  const glm::dvec3 depth(bend_->depth[0], bend_->depth[1], bend_->depth[2]);
  return column(0) * across + column(1) * w.y + column(2) + depth * away;
}

glm::dvec2 ScreenView::imageFromWall(glm::dvec2 pointInWall) const {
  const glm::dvec3 p = project(pointInWall);
  return glm::dvec2(p.x, p.y) / p.z;
}

std::optional<glm::dvec2> ScreenView::wallFromImage(glm::dvec2 pointInImage) const {
  return bend_ ? meetCylinder(pointInImage) : std::optional(wallFromImage_.map(pointInImage));
}

/// The ray q and the generator b of the cylinder span a plane of normal n = b x q; the screen's points in it solve an
/// equation in the angle alone.
std::optional<glm::dvec2> ScreenView::meetCylinder(glm::dvec2 pointInImage) const {
  const glm::dvec3 q(pointInImage, 1);
  const glm::dvec3 depth(bend_->depth[0], bend_->depth[1], bend_->depth[2]);
  const glm::dvec3 n = glm::cross(column(1), q);
  const double radius = bend_->radius;
  const double away = radius * glm::dot(n, depth);
  const auto t = smallerAngle(radius * glm::dot(n, column(0)), away,
                              glm::dot(n, column(2)) + bend_->apex * glm::dot(n, column(0)) - away);
  if (!t || std::abs(*t) >= std::numbers::pi / 2) return std::nullopt;
  const glm::dvec3 foot =
      column(0) * (bend_->apex + radius * std::sin(*t)) + column(2) + depth * (radius * (std::cos(*t) - 1));
  const double y = -glm::dot(glm::cross(foot, q), n) / glm::dot(n, n);
  return glm::dvec2(bend_->apex + radius * *t, y);
}

double ScreenView::weight(glm::dvec2 pointInWall) const {
  return project(pointInWall).z;
}

Homography ScreenView::imageFromTangent(glm::dvec2 w) const {
  if (!bend_) return imageFromWall_;
  const double t = (w.x - bend_->apex) / bend_->radius;
  const glm::dvec3 depth(bend_->depth[0], bend_->depth[1], bend_->depth[2]);
  const glm::dvec3 along = column(0) * std::cos(t) - depth * std::sin(t);
  const glm::dvec3 origin = project({w.x, 0}) - along * w.x;
  const glm::dvec3 down = column(1);
  return Homography({along.x, down.x, origin.x, along.y, down.y, origin.y, along.z, down.z, origin.z});
}

}  // namespace pixelflex::calib
