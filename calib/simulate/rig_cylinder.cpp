#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <utility>

#include "calib/simulate/overlap.h"
#include "calib/simulate/rig_generator.h"
#include "calib/simulate/rig_parts.h"
#include "calib/simulate/stage.h"

namespace pixelflex::calib {

namespace {

constexpr double kRadius = 3000;    // mm
constexpr double kArcWidth = 1400;  // of a frame, mm along the screen
constexpr double kLeastOverlap = 0.155;
constexpr double kMostOverlap = 0.245;

/// As aim, on a curved screen: square on is towards the screen at its target, not towards the plane.
void aimAtScreen(SimulatedProjectorSpec& spec, const Screen& screen, const Place& place, double slack, Random& random) {
  const HandAim hand = drawAim(spec.resolution, place, slack, random);
  const glm::dvec3 normal = screen.normal(hand.target);
  const double yaw = glm::degrees(std::atan2(-normal.x, -normal.z));
  spec.pose.rotation = decimals(hand.turn + glm::dvec3(yaw, 0, 0), 2);
  const glm::dvec2 middle(0.5 * spec.resolution.width, 0.5 * spec.resolution.height);
  const auto along = PlacedOptics(spec.pose, spec.optics).direction(middle).value_or(glm::dvec3(0, 0, 1));
  const glm::dvec3 target = screen.roomFromWall(hand.target);
  double distance = place.width;
  for (int step = 0; step < 12; ++step) {
    spec.pose.position = decimals(target - along * distance, 1);
    distance *= std::sqrt(hand.area / litArea(ProjectorLight(spec, screen)));
  }
}

/// To the right of the one before.
void addBeside(Rig& rig, glm::dvec2 target, Random& random) {
  constexpr int kTries = 200;
  const auto screen = makeScreen(rig);
  auto spec = drawProjector(random, {1920, 1080}, nextName(rig));
  for (int attempt = 0; attempt <= kTries; ++attempt) {
    // Less and less casual, so that an end is certain.
    aimAtScreen(spec, *screen, {target, kArcWidth}, 1 - static_cast<double>(attempt) / kTries, random);
    if (rig.projectors.empty()) break;
    const auto overlap =
        overlapSideBySide(ProjectorLight(rig.projectors.back(), *screen), ProjectorLight(spec, *screen));
    if (overlap.least >= kLeastOverlap && overlap.most <= kMostOverlap) break;
  }
  rig.projectors.push_back(std::move(spec));
}

/// Reaches a little beyond everything, as far to the left as to the right, so that the place where it touches the plane
/// stays its middle.
void addCurvedScreen(Rig& rig) {
  const WallBounds all = boundsOfScreen(rig);
  const double half = std::ceil(std::max(-all.low.x, all.high.x));
  rig.screenTopLeft = {0, 0};
  rig.screenSize = {2 * half, std::ceil(all.high.y - all.low.y)};
  moveOrigin(rig, {-half, all.low.y});
}

}  // namespace

Rig cylinderRig(std::uint32_t seed) {
  constexpr int kMarkersAcross = 5;
  Random random(seed);
  Rig rig{.seed = seed};
  rig.screenRadius = kRadius;
  rig.screenTopLeft.x = -0.5 * rig.screenSize.x;  // touches the plane at wall x = 0
  for (const int place : {-1, 0, 1}) addBeside(rig, {place * (1 - kFrameOverlap) * kArcWidth, 0}, random);
  const WallBounds picture = boundsOfFrames(rig);
  const double side = markerSide(picture.high.x - picture.low.x, rig.camera.size.width - 80.0);
  addMarkerRows(rig, kMarkersAcross, side, random);
  addCurvedScreen(rig);
  placeCamera(rig);
  return rig;
}

}  // namespace pixelflex::calib
