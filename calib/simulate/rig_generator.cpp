#include "calib/simulate/rig_generator.h"

#include <array>
#include <cassert>
#include <utility>

#include "calib/simulate/overlap.h"
#include "calib/simulate/planar_screen.h"
#include "calib/simulate/rig_parts.h"

namespace pixelflex::calib {

namespace {

constexpr double kLeastOverlap = 0.12;
constexpr double kMostOverlap = 0.28;

bool fits(Overlap overlap) {
  return overlap.least >= kLeastOverlap && overlap.most <= kMostOverlap;
}

void addProjector(Rig& rig, int column, int row, int columns, devices::Size resolution, Random& random) {
  constexpr int kTries = 200;
  const PlanarScreen screen;
  const double height = kFrameWidth * resolution.height / resolution.width;
  const glm::dvec2 target = (1 - kFrameOverlap) * glm::dvec2(column * kFrameWidth, row * height);
  auto spec = drawProjector(random, resolution, nextName(rig));
  for (int attempt = 0; attempt <= kTries; ++attempt) {
    // Less and less casual, so that an end is certain: square on, the grid overlaps as planned.
    aim(spec, {target}, 1 - static_cast<double>(attempt) / kTries, random);
    const ProjectorLight light(spec, screen);
    const auto at = [&](int c, int r) {
      return ProjectorLight(rig.projectors.at(static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) +
                                              static_cast<std::size_t>(c)),
                            screen);
    };
    if (column > 0 && !fits(overlapSideBySide(at(column - 1, row), light))) continue;
    if (row > 0 && !fits(overlapOneAboveOther(at(column, row - 1), light))) continue;
    break;
  }
  rig.projectors.push_back(spec);
}

void addGrid(Rig& rig, int columns, int rows, devices::Size resolution, Random& random) {
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) addProjector(rig, column, row, columns, resolution, random);
  }
}

/// All around the picture: so many more along the top and the bottom, and two at either side.
void addMarkerFrame(Rig& rig, int across, double side, Random& random) {
  const WallBounds picture = boundsOfFrames(rig);
  addMarkerRows(rig, across, side, random);
  for (const double x : {picture.low.x - 0.85 * side, picture.high.x + 0.85 * side}) {
    for (const double part : {0.33, 0.67}) {
      addMarker(rig, {x, picture.low.y + part * (picture.high.y - picture.low.y)}, side, random);
    }
  }
}

/// Where a person puts the camera for one part of the wall: it looks at `target` from about `distance`.
Pose drawPlace(glm::dvec2 target, double distance, Random& random) {
  Pose place;
  place.rotation = decimals({random.between(-7, 7), random.between(-5, 5), random.between(-1.5, 1.5)}, 1);
  const glm::dvec3 along = roomFromDevice(place.rotation) * glm::dvec3(0, 0, 1);
  place.position = glm::round(glm::dvec3(target, 0) - along * (distance * random.between(0.97, 1.03)));
  return place;
}

/// Three by two places, each for about half of the wall's width and two thirds of its height.
void drawPlaces(Rig& rig, double cameraPixelsPerUnit, Random& random) {
  constexpr double kReach = 0.46;  // of the picture: how far the wall's edge is from its middle
  rig.camera.optics = wideLens(rig.camera.size);
  const glm::dvec2 reach = kReach * glm::dvec2(rig.camera.size.width, rig.camera.size.height) / cameraPixelsPerUnit;
  const double distance = rig.camera.optics.focal / cameraPixelsPerUnit;
  const std::array columns{reach.x, 0.5 * rig.screenSize.x, rig.screenSize.x - reach.x};
  for (const double y : {reach.y, rig.screenSize.y - reach.y}) {
    for (const double x : columns) rig.cameraPlaces.push_back(drawPlace({x, y}, distance, random));
  }
  rig.camera.pose = rig.cameraPlaces.front();
  rig.cameraPlaces.erase(rig.cameraPlaces.begin());
}

}  // namespace

Rig casualRig(int columns, int rows, devices::Size resolution, std::uint32_t seed, devices::Size cameraSize) {
  assert(columns > 0 && rows > 0);
  Random random(seed);
  Rig rig;
  rig.seed = seed;
  rig.camera.size = cameraSize;
  addGrid(rig, columns, rows, resolution, random);
  return finished(std::move(rig), random);
}

Rig reportRig(std::uint32_t seed) {
  return casualRig(4, 2, {1024, 768}, seed);
}

Rig miniRig(std::uint32_t seed) {
  return casualRig(2, 1, {640, 480}, seed, {960, 600});
}

Rig largeRig(std::uint32_t seed) {
  constexpr devices::Size kResolution{1024, 768};
  constexpr double kCameraPixelsPerUnit = 0.58 * kResolution.width / kFrameWidth;
  Random random(seed);
  Rig rig{.seed = seed};
  addGrid(rig, 6, 3, kResolution, random);
  addMarkerFrame(rig, 7, markerSide(1, kCameraPixelsPerUnit), random);
  addPlanarScreen(rig);
  drawPlaces(rig, kCameraPixelsPerUnit, random);
  return rig;
}

}  // namespace pixelflex::calib
