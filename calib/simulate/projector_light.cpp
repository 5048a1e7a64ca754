#include "calib/simulate/projector_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace pixelflex::calib {

double channelLight(const Response& response, int channel, double code01) {
  const auto c = static_cast<std::size_t>(channel);
  const double above = std::clamp((code01 - response.toe) / (1 - response.toe), 0.0, 1.0);
  const double curve = std::pow(above, response.gamma.at(c));
  return response.gain.at(c) * (response.black + (1 - response.black) * curve);
}

ProjectorLight::ProjectorLight(const SimulatedProjectorSpec& spec, const Screen& screen)
    : spec_(spec), screen_(screen), optics_(spec.pose, spec.optics) {}

std::optional<glm::dvec2> ProjectorLight::wallFromPixel(glm::dvec2 pointInProjector) const {
  return optics_.wallFromPixel(screen_, pointInProjector);
}

std::optional<glm::dvec2> ProjectorLight::pixelFromWall(glm::dvec2 pointInWall) const {
  return optics_.pixelFromWall(screen_, pointInWall);
}

double ProjectorLight::frameWeight(glm::dvec2 pointInProjector) const {
  const glm::dvec2 half(0.5 * spec_.resolution.width, 0.5 * spec_.resolution.height);
  const glm::dvec2 off = pointInProjector - half;
  const double fall = glm::dot(off, off) / glm::dot(half, half);  // 0 in the middle, 1 in a corner
  // The mean of `fall` over a rectangle is 1/3: dividing keeps the total flux at the stated lumens.
  return std::max(0.0, 1 - spec_.vignetting * fall) / (1 - spec_.vignetting / 3);
}

double ProjectorLight::illuminance(glm::dvec2 pointInWall) const {
  constexpr double kStep = 0.25;  // mm; central differences of a smooth map, good to 1e-8
  const auto pixel = pixelFromWall(pointInWall);
  const auto left = pixelFromWall(pointInWall - glm::dvec2(kStep, 0));
  const auto right = pixelFromWall(pointInWall + glm::dvec2(kStep, 0));
  const auto up = pixelFromWall(pointInWall - glm::dvec2(0, kStep));
  const auto down = pixelFromWall(pointInWall + glm::dvec2(0, kStep));
  if (!pixel || !left || !right || !up || !down) return 0;
  const glm::dvec2 byX = (*right - *left) / (2 * kStep);
  const glm::dvec2 byY = (*down - *up) / (2 * kStep);
  const double pixelsPerArea = std::abs(byX.x * byY.y - byX.y * byY.x);
  return spec_.lumens / static_cast<double>(spec_.resolution.area()) * frameWeight(*pixel) * pixelsPerArea;
}

ProjectorLight::Level ProjectorLight::level() const {
  constexpr int kGrid = 24;
  Level level;
  for (int row = 0; row <= kGrid; ++row) {
    for (int column = 0; column <= kGrid; ++column) {
      const glm::dvec2 at(spec_.resolution.width * column / double{kGrid},
                          spec_.resolution.height * row / double{kGrid});
      const auto wall = wallFromPixel(at);
      const double here = wall ? illuminance(*wall) : 0;
      level.maximum = std::max(level.maximum, here);
      level.mean += here / ((kGrid + 1) * (kGrid + 1));
    }
  }
  return level;
}

}  // namespace pixelflex::calib
