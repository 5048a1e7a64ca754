#include "calib/simulate/cylindrical_screen.h"

#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace pixelflex::calib {

namespace {

constexpr double kNearest = 1e-9;  // of the ray's direction: hits are before the device, not in it

double largestAngle() {
  return glm::radians(kLargestArcAngle);
}

}  // namespace

CylindricalScreen::CylindricalScreen(double radius, double apex) : radius_(radius), apex_(apex) {
  assert(radius != 0);
}

std::optional<CylindricalScreen::Crossing> CylindricalScreen::cross(glm::dvec3 origin, glm::dvec3 direction) const {
  // Seen from above, about the axis: a ray and a circle.
  const glm::dvec2 from(origin.x - apex_, origin.z + radius_);
  const glm::dvec2 along(direction.x, direction.z);
  const double a = glm::dot(along, along);
  if (a <= 0) return std::nullopt;  // straight up or down
  const double b = glm::dot(from, along);
  const double c = glm::dot(from, from) - radius_ * radius_;
  const double root = b * b - a * c;
  if (root <= 0) return std::nullopt;
  // The root that adds numbers of equal sign first; the other one follows from their product.
  const double q = b > 0 ? -b - std::sqrt(root) : -b + std::sqrt(root);
  if (q == 0) return std::nullopt;
  return b > 0 ? Crossing{q / a, c / q} : Crossing{c / q, q / a};
}

double CylindricalScreen::angleOf(glm::dvec3 point) const {
  return std::atan2((point.x - apex_) / radius_, (point.z + radius_) / radius_);
}

bool CylindricalScreen::isOnArc(glm::dvec3 point) const {
  return std::abs(angleOf(point)) < largestAngle();
}

bool CylindricalScreen::backIsInTheWay(const Crossing& crossing, glm::dvec3 origin, glm::dvec3 direction) const {
  return crossing.enter > kNearest && isOnArc(origin + crossing.enter * direction);
}

std::optional<glm::dvec3> CylindricalScreen::hit(glm::dvec3 origin, glm::dvec3 direction) const {
  const auto crossing = cross(origin, direction);
  if (!crossing) return std::nullopt;
  const bool hollow = radius_ > 0;
  if (hollow && backIsInTheWay(*crossing, origin, direction)) return std::nullopt;
  const double distance = hollow ? crossing->leave : crossing->enter;
  const glm::dvec3 point = origin + distance * direction;
  if (distance <= kNearest || !isOnArc(point)) return std::nullopt;
  return point;
}

glm::dvec2 CylindricalScreen::wallFromRoom(glm::dvec3 point) const {
  return {apex_ + radius_ * angleOf(point), point.y};
}

glm::dvec3 CylindricalScreen::roomFromWall(glm::dvec2 pointInWall) const {
  const double angle = (pointInWall.x - apex_) / radius_;
  const double half = std::sin(0.5 * angle);  // cos - 1 = -2 half^2 without the loss of digits
  return {apex_ + radius_ * std::sin(angle), pointInWall.y, -2 * radius_ * half * half};
}

glm::dvec3 CylindricalScreen::normal(glm::dvec2 pointInWall) const {
  const double angle = (pointInWall.x - apex_) / radius_;
  return {-std::sin(angle), 0, -std::cos(angle)};
}

bool CylindricalScreen::isVisible(glm::dvec3 from, glm::dvec2 pointInWall) const {
  if (std::abs(pointInWall.x - apex_) >= largestAngle() * std::abs(radius_)) return false;
  const glm::dvec3 along = roomFromWall(pointInWall) - from;
  if (glm::dot(along, normal(pointInWall)) >= 0) return false;
  if (radius_ < 0) return true;  // a bulging screen hides nothing that faces the eye
  const auto crossing = cross(from, along);
  return crossing && !backIsInTheWay(*crossing, from, along);
}

}  // namespace pixelflex::calib
