#include "calib/simulate/lens.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace pixelflex::calib {

namespace {

constexpr double kLargestRadius = 4.0;  // a ray 76 degrees off the axis

/// Derivative of r * (1 + k1 r^2 + k2 r^4 + k3 r^6).
double radialSlope(const Optics& optics, double radius) {
  const double r2 = radius * radius;
  return 1 + r2 * (3 * optics.radial[0] + r2 * (5 * optics.radial[1] + r2 * 7 * optics.radial[2]));
}

double findFold(const Optics& optics) {
  constexpr double kStep = 1.0 / 256;
  for (double radius = kStep; radius < kLargestRadius; radius += kStep) {
    if (radialSlope(optics, radius) <= 0) return radius - kStep;
  }
  return kLargestRadius;
}

}  // namespace

Lens::Lens(const Optics& optics) : optics_(optics), foldRadius_(findFold(optics)) {}

glm::dvec2 Lens::distorted(glm::dvec2 ray) const {
  const auto [k1, k2, k3] = optics_.radial;
  const auto [p1, p2] = optics_.tangential;
  const double r2 = glm::dot(ray, ray);
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double xy = ray.x * ray.y;
  return ray * radial +
         glm::dvec2(2 * p1 * xy + p2 * (r2 + 2 * ray.x * ray.x), p1 * (r2 + 2 * ray.y * ray.y) + 2 * p2 * xy);
}

glm::dmat2 Lens::slope(glm::dvec2 ray) const {
  const auto [k1, k2, k3] = optics_.radial;
  const auto [p1, p2] = optics_.tangential;
  const double r2 = glm::dot(ray, ray);
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double growth = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));  // d(radial)/dx is x * growth
  const double cross = ray.x * ray.y * growth + 2 * p1 * ray.x + 2 * p2 * ray.y;
  return {{radial + ray.x * ray.x * growth + 2 * p1 * ray.y + 6 * p2 * ray.x, cross},
          {cross, radial + ray.y * ray.y * growth + 6 * p1 * ray.y + 2 * p2 * ray.x}};
}

std::optional<glm::dvec2> Lens::pixelFromRay(glm::dvec2 ray) const {
  if (glm::dot(ray, ray) > foldRadius_ * foldRadius_) return std::nullopt;
  return optics_.focal * distorted(ray) + optics_.principal;
}

std::optional<glm::dvec2> Lens::rayFromPixel(glm::dvec2 pixel) const {
  const glm::dvec2 target = (pixel - optics_.principal) / optics_.focal;
  glm::dvec2 ray = target;
  if (glm::length(ray) > foldRadius_) ray *= 0.9 * foldRadius_ / glm::length(ray);
  for (int step = 0; step < 40; ++step) {
    const glm::dvec2 miss = distorted(ray) - target;
    const glm::dmat2 jacobian = slope(ray);
    const double determinant = glm::determinant(jacobian);
    if (std::abs(determinant) < 1e-9) return std::nullopt;
    const glm::dvec2 change = glm::inverse(jacobian) * miss;
    ray -= change;
    if (!(glm::dot(ray, ray) < 4 * kLargestRadius * kLargestRadius)) return std::nullopt;
    if (glm::dot(change, change) < 1e-26) {
      return glm::length(ray) <= foldRadius_ ? std::optional(ray) : std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace pixelflex::calib
