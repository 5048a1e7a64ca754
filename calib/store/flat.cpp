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

ProjectorCalibration flatProjector(const ProjectorConfig& config) {
  assert(config.flatAt);
  const glm::dvec2 at(*config.flatAt);
  ProjectorCalibration projector;
  projector.name = config.name;
  projector.resolution = config.resolution;
  projector.samples = cornerSamples(at, config.resolution);
  projector.model.projectorFromWall = {1, 0, -at.x, 0, 1, -at.y, 0, 0, 1};
  projector.quality = {.found = 4, .shown = 4};
  projector.flatAt = config.flatAt;
  return projector;
}

}  // namespace

Calibration flatCalibration(const Wall& wall) {
  assert(wall.isFlat());
  Calibration calibration;
  devices::Size desktop;
  for (const auto& config : wall.projectors) {
    calibration.projectors.push_back(flatProjector(config));
    desktop.width = std::max(desktop.width, config.flatAt->x + config.resolution.width);
    desktop.height = std::max(desktop.height, config.flatAt->y + config.resolution.height);
  }
  calibration.display =
      Display{.right = double(desktop.width), .bottom = double(desktop.height), .resolution = desktop};
  return calibration;
}

}  // namespace pixelflex::calib
