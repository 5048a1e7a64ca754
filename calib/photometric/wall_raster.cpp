#include "calib/photometric/wall_raster.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <limits>

namespace pixelflex::calib {

std::optional<double> valueAt(const devices::ImageF& map, glm::dvec2 pointInRaster) {
  assert(map.channels() == 1);
  const glm::dvec2 last(map.width() - 1, map.height() - 1);
  const glm::dvec2 p = glm::clamp(pointInRaster - 0.5, glm::dvec2(0), last);
  const int x = std::min(static_cast<int>(p.x), std::max(0, map.width() - 2));
  const int y = std::min(static_cast<int>(p.y), std::max(0, map.height() - 2));
  double sum = 0;
  double weights = 0;
  for (int j = 0; j < std::min(2, map.height()); ++j) {
    for (int i = 0; i < std::min(2, map.width()); ++i) {
      const double value = map.at(x + i, y + j);
      const double weight = std::max(1e-9, (1 - std::abs(p.x - x - i)) * (1 - std::abs(p.y - y - j)));
      if (!(value > 0)) continue;
      sum += weight * value;
      weights += weight;
    }
  }
  if (weights > 0) return sum / weights;
  return std::nullopt;
}

std::optional<double> valueNear(const devices::ImageF& map, glm::dvec2 pointInRaster, int reach) {
  if (const auto value = valueAt(map, pointInRaster)) return value;
  const glm::dvec2 p = glm::clamp(pointInRaster, glm::dvec2(0), glm::dvec2(map.width(), map.height()) - 0.5);
  const int x0 = static_cast<int>(p.x);
  const int y0 = static_cast<int>(p.y);
  std::optional<double> nearest;
  double least = std::numeric_limits<double>::max();
  for (int y = std::max(0, y0 - reach); y <= std::min(map.height() - 1, y0 + reach); ++y) {
    for (int x = std::max(0, x0 - reach); x <= std::min(map.width() - 1, x0 + reach); ++x) {
      const double distance = std::hypot(x + 0.5 - pointInRaster.x, y + 0.5 - pointInRaster.y);
      if (map.at(x, y) > 0 && distance < least) {
        least = distance;
        nearest = map.at(x, y);
      }
    }
  }
  return nearest;
}

}  // namespace pixelflex::calib
