#include <fmt/format.h>

#include <cmath>

#include "calib/simulate/projector_light.h"
#include "calib/simulate/random.h"
#include "calib/simulate/rig.h"

namespace pixelflex::calib {

Wall wallOfRig(const Rig& rig, const std::string& rigFile) {
  Wall wall;
  wall.rig = rigFile;
  wall.camera = {"sim", rig.checkerboard};
  if (rig.screenRadius != 0) {
    wall.surface.shape = SurfaceShape::kCylinder;
    wall.surface.cylinderRadius = std::abs(rig.screenRadius);  // hollow or bulging is for the calibration to find
  }
  for (const auto& marker : rig.markers) {
    wall.surface.fiducials.push_back({.aruco = marker.aruco, .pointInCamera = {}, .pointInWall = marker.centre});
  }
  for (const auto& projector : rig.projectors) {
    ProjectorConfig config;
    config.name = projector.name;
    config.resolution = projector.resolution;
    config.output.kind = OutputKind::kSim;
    config.gamma = "readings/" + projector.name + ".csv";
    wall.projectors.push_back(config);
  }
  return wall;
}

std::string readingsOfProjector(const SimulatedProjectorSpec& projector, std::uint32_t seed) {
  constexpr double kNoise = 0.002;  // of the reading
  constexpr double kWhite = 320;    // cd/m2 of a channel of gain 1, as a meter close to the screen shows it
  Random random(seed);
  std::string text = "value,red,green,blue\n";
  for (int code = 0; code < 256; ++code) {
    text += std::to_string(code);
    for (int channel = 0; channel < 3; ++channel) {
      const double light = kWhite * channelLight(projector.response, channel, code / 255.0);
      text += fmt::format(",{:.5f}", light * (1 + kNoise * random.normal()));
    }
    text += '\n';
  }
  return text;
}

}  // namespace pixelflex::calib
