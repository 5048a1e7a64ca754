#include "calib/geometry/residual_map.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

namespace pixelflex::calib {
namespace {

/// The uniform cubic B-spline's four weights at a place within a cell, 0..1.
std::array<double, 4> basis(double t) {
  const double s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
}

struct Place {
  int cell = 0;
  std::array<double, 4> weights{};
};

Place placeOf(double coordinate, double extent, int cells) {
  const double at = std::clamp(coordinate / extent, 0.0, 1.0) * cells;
  const int cell = std::min(static_cast<int>(at), cells - 1);
  return {cell, basis(at - cell)};
}

}  // namespace

ResidualMap::ResidualMap(ResidualSpline spline, devices::Size resolution)
    : spline_(std::move(spline)), resolution_(resolution) {}

ResidualMap::Support ResidualMap::supportOf(const ResidualSpline& spline, devices::Size resolution, glm::dvec2 point) {
  const Place x = placeOf(point.x, resolution.width, spline.columns);
  const Place y = placeOf(point.y, resolution.height, spline.rows);
  const auto stride = static_cast<std::size_t>(spline.columns) + 3;
  Support support;
  for (std::size_t i = 0; i < 16; ++i) {
    support.index[i] = (static_cast<std::size_t>(y.cell) + i / 4) * stride + static_cast<std::size_t>(x.cell) + i % 4;
    support.weight[i] = y.weights[i / 4] * x.weights[i % 4];
  }
  return support;
}

glm::dvec2 ResidualMap::correction(glm::dvec2 point) const {
  if (spline_.columns == 0) return {0, 0};
  const Support support = supportOf(spline_, resolution_, point);
  glm::dvec2 sum{0, 0};
  for (std::size_t i = 0; i < 16; ++i) sum += support.weight[i] * spline_.control[support.index[i]];
  return sum;
}

glm::dvec2 ResidualMap::apply(glm::dvec2 point) const {
  return point + correction(point);
}

std::optional<glm::dvec2> ResidualMap::invert(glm::dvec2 pointInProjector) const {
  constexpr double kExact = 1e-10;
  constexpr int kMostIterations = 100;
  glm::dvec2 point = pointInProjector;
  for (int i = 0; i < kMostIterations; ++i) {
    const glm::dvec2 off = pointInProjector - apply(point);
    if (glm::dot(off, off) < kExact * kExact) return point;
    point += off;
  }
  return std::nullopt;
}

}  // namespace pixelflex::calib
