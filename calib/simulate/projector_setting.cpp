#include "calib/simulate/projector_setting.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "calib/simulate/placed_optics.h"

namespace pixelflex::calib {
namespace {

constexpr double kZoom = 1.14;   // of the picture's size, to either end: 1 to 1.3 in all, as projectors have it
constexpr double kShift = 0.25;  // of the frame's extent, to either end
constexpr double kBlur = 4;      // pixels (sigma), at either end of the focus

glm::dmat3 reflection(glm::dvec3 normal) {
  return glm::dmat3(1) - 2.0 * glm::outerProduct(normal, normal);
}

/// Device axes are x right, y down, z along the beam behind the mirror.
glm::dvec3 mirrorNormal(glm::dvec2 degrees) {
  const glm::dvec2 turned = glm::radians(degrees);
  const glm::dvec3 tilted(0, std::cos(turned.y) - std::sin(turned.y), std::sin(turned.y) + std::cos(turned.y));
  const glm::dvec3 panned(std::sin(turned.x) * tilted.z, tilted.y, std::cos(turned.x) * tilted.z);
  return glm::normalize(panned);
}

/// Yaw, pitch and roll of a rotation, as roomFromDevice() takes them.
glm::dvec3 anglesOf(const glm::dmat3& rotation) {
  return glm::degrees(glm::dvec3(std::atan2(rotation[2].x, rotation[2].z),
                                 std::asin(std::clamp(-rotation[2].y, -1.0, 1.0)),
                                 std::atan2(rotation[0].y, rotation[1].y)));
}

Pose seenInMirror(const Pose& pose, double distance, glm::dvec2 degrees) {
  const glm::dmat3 before = roomFromDevice(pose.rotation);
  const glm::dvec3 mirror = pose.position + distance * before[2];
  // The mirror at rest shows the projector at `pose`; two reflections lead from there by way of the real place.
  const glm::dmat3 after = before * (reflection(mirrorNormal(degrees)) * reflection(mirrorNormal({0, 0})));
  return {mirror - distance * after[2], anglesOf(after)};
}

}  // namespace

SimulatedProjectorSpec asSet(SimulatedProjectorSpec spec, const ProjectorSetting& setting) {
  if (setting.mirror != glm::dvec2(0, 0)) spec.pose = seenInMirror(spec.pose, spec.mirrorDistance, setting.mirror);
  spec.optics.focal *= std::pow(kZoom, -setting.zoom);
  spec.optics.principal += kShift * setting.shift * glm::dvec2(spec.resolution.width, spec.resolution.height);
  spec.defocus = std::hypot(spec.defocus, kBlur * setting.focus);
  if (!setting.lit) spec.lumens = 0;
  return spec;
}

devices::Image8 asSet(devices::Image8 frame, const ProjectorSetting& setting) {
  if (setting.muted || frame.empty()) return {};
  const bool plain = setting.brightness == 0 && setting.contrast == 1 && setting.gain == std::array<double, 3>{1, 1, 1};
  if (plain) return frame;
  devices::Image8 out(frame.size(), 3);
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      for (int c = 0; c < 3; ++c) {
        const double code = frame.at(x, y, frame.channels() < 3 ? 0 : c);
        const double set =
            (code * setting.contrast + setting.brightness) * setting.gain.at(static_cast<std::size_t>(c));
        out.at(x, y, c) = static_cast<std::uint8_t>(std::lround(std::clamp(set, 0.0, 255.0)));
      }
    }
  }
  return out;
}

}  // namespace pixelflex::calib
