#include <algorithm>
#include <cassert>
#include <vector>

#include "calib/store/store.h"

namespace pixelflex::calib {
namespace {

std::vector<Sample> cornerSamples(glm::dvec2 at, devices::Size resolution) {
  std::vector<Sample> samples;
  for (const glm::dvec2 corner : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1), glm::dvec2(0, 1)}) {
    const glm::dvec2 pointInProjector = corner * glm::dvec2(resolution.width, resolution.height);
    samples.push_back({pointInProjector, pointInProjector + at});
  }
  return samples;
}

ProjectorCalibration flatProjector(const ProjectorConfig& config, glm::ivec2 flatAt) {
  const glm::dvec2 at(flatAt);
  ProjectorCalibration projector;
  projector.name = config.name;
  projector.resolution = config.resolution;
  projector.samples = cornerSamples(at, config.resolution);
  projector.model.projectorFromWall = {1, 0, -at.x, 0, 1, -at.y, 0, 0, 1};
  projector.quality.found = 4;
  projector.quality.shown = 4;
  projector.flatAt = flatAt;
  return projector;
}

}  // namespace

Calibration flatCalibration(const Wall& wall) {
  assert(wall.isFlat());
  Calibration calibration;
  devices::Size desktop;
  for (const auto& config : wall.projectors) {
    const glm::ivec2 at = config.flatAt.value();
    calibration.projectors.push_back(flatProjector(config, at));
    desktop.width = std::max(desktop.width, at.x + config.resolution.width);
    desktop.height = std::max(desktop.height, at.y + config.resolution.height);
  }
  calibration.display = Display{0, 0, static_cast<double>(desktop.width), static_cast<double>(desktop.height), desktop};
  return calibration;
}

}  // namespace pixelflex::calib
