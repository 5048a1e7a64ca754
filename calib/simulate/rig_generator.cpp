#include "calib/simulate/rig_generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>

#include "calib/simulate/camera_fit.h"
#include "calib/simulate/overlap.h"
#include "calib/simulate/planar_screen.h"
#include "calib/simulate/random.h"

namespace pixelflex::calib {

namespace {

constexpr double kFrameWidth = 1300;  // mm on the wall
constexpr double kOverlap = 0.2;
constexpr double kLeastOverlap = 0.12;
constexpr double kMostOverlap = 0.28;

constexpr std::array kTwoByTwo{glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)};

double rounded(double value, double step) {
  return std::round(value / step) * step;
}

/// Decimal places that a person would write; keeps rig files readable.
double decimals(double value, int places) {
  const double scale = std::pow(10.0, places);
  return std::round(value * scale) / scale;
}

glm::dvec3 decimals(glm::dvec3 value, int places) {
  return {decimals(value.x, places), decimals(value.y, places), decimals(value.z, places)};
}

Optics drawLens(Random& random, devices::Size size) {
  Optics optics;
  optics.focal = decimals(size.width * random.between(1.5, 1.7), 1);
  // Lens shift: projectors throw upwards or downwards, and a little sideways.
  const double shift = random.between(0.05, 0.25) * (random.between(-1, 1) < 0 ? -1 : 1);
  optics.principal = {decimals(size.width * (0.5 + random.between(-0.02, 0.02)), 1),
                      decimals(size.height * (0.5 + shift), 1)};
  const double k1 = random.between(0.02, 0.05) * (random.between(-1, 1) < 0 ? -1 : 1);
  optics.radial = {decimals(k1, 4), decimals(-k1 * random.between(0.3, 1.2), 4), 0};
  optics.tangential = {decimals(random.between(-0.0015, 0.0015), 5), decimals(random.between(-0.0015, 0.0015), 5)};
  return optics;
}

Response drawResponse(Random& random) {
  Response response;
  const double gamma = random.between(1.95, 2.45);
  for (double& channel : response.gamma) channel = decimals(gamma + random.between(-0.05, 0.05), 3);
  for (double& channel : response.gain) channel = decimals(random.between(0.92, 1.08), 3);
  response.toe = decimals(random.between(0, 0.015), 4);
  response.black = decimals(random.between(0.001, 0.004), 4);
  return response;
}

SimulatedProjectorSpec drawProjector(Random& random, devices::Size resolution, std::string name) {
  SimulatedProjectorSpec spec;
  spec.name = std::move(name);
  spec.resolution = resolution;
  spec.optics = drawLens(random, resolution);
  spec.response = drawResponse(random);
  spec.lumens = std::round(1500 * random.between(0.85, 1.15));
  spec.vignetting = decimals(random.between(0.22, 0.35), 3);
  spec.defocus = decimals(random.between(0.4, 0.7), 2);
  return spec;
}

/// The area that four corners enclose.
double litArea(const ProjectorLight& light) {
  const glm::dvec2 size(light.spec().resolution.width, light.spec().resolution.height);
  const std::array corners{glm::dvec2(0, 0), glm::dvec2(size.x, 0), size, glm::dvec2(0, size.y)};
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto a = light.wallFromPixel(corners.at(i)).value_or(glm::dvec2(0));
    const auto b = light.wallFromPixel(corners.at((i + 1) % corners.size())).value_or(glm::dvec2(0));
    twice += a.x * b.y - a.y * b.x;
  }
  return std::abs(twice) / 2;
}

/// The part of the wall that a frame is meant for.
struct Place {
  glm::dvec2 target{0, 0};     // of the frame's middle, mm
  double width = kFrameWidth;  // of the frame, mm along the projector's own rows
  double roll = 0;             // degrees: 90 for a projector that stands on its side
};

/// Aims by hand: turned by up to `slack` times the largest angles, at the distance where the frame has its nominal
/// area.
void aim(SimulatedProjectorSpec& spec, const Place& place, double slack, Random& random) {
  const glm::dvec2 size(spec.resolution.width, spec.resolution.height);
  const double width = place.width;
  const double height = width * size.y / size.x;
  const glm::dvec3 turn(random.between(-8, 8), random.between(-8, 8), random.between(-2.5, 2.5));
  spec.pose.rotation = decimals(slack * turn + glm::dvec3(0, 0, place.roll), 2);
  const glm::dvec2 at =
      place.target + slack * 0.03 * glm::dvec2(random.between(-width, width), random.between(-height, height));
  const PlanarScreen screen;
  const auto along = PlacedOptics(spec.pose, spec.optics).direction(0.5 * size).value_or(glm::dvec3(0, 0, 1));
  spec.pose.position = glm::dvec3(at, 0) - along * width;
  // On a plane the lit area grows with the square of the distance.
  const double wanted = width * height * (1 + slack * random.between(-0.03, 0.03));
  const double scale = std::sqrt(wanted / litArea(ProjectorLight(spec, screen)));
  spec.pose.position = decimals(glm::dvec3(at, 0) - along * (width * scale), 1);
}

bool fits(Overlap overlap) {
  return overlap.least >= kLeastOverlap && overlap.most <= kMostOverlap;
}

void addProjector(Rig& rig, int column, int row, int columns, devices::Size resolution, Random& random) {
  constexpr int kTries = 200;
  const PlanarScreen screen;
  const double height = kFrameWidth * resolution.height / resolution.width;
  const glm::dvec2 target = (1 - kOverlap) * glm::dvec2(column * kFrameWidth, row * height);
  auto spec = drawProjector(random, resolution, fmt::format("p{}", rig.projectors.size() + 1));
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

WallBounds boundsOf(const Rig& rig) {
  WallBounds bounds;
  for (const glm::dvec2 point : frameOutlines(rig)) bounds.include(point);
  return bounds;
}

/// Above and below the picture, six on wide walls and four on narrow ones; about 55 camera pixels wide.
void addMarkers(Rig& rig, Random& random) {
  const WallBounds picture = boundsOf(rig);
  const glm::dvec2 size = picture.high - picture.low;
  const double pixelsAcross = std::min(rig.camera.size.width - 80.0, 1.4 * rig.camera.size.height * size.x / size.y);
  const double side = rounded(58 * size.x / pixelsAcross, 5);
  const int across = size.x > 2 * size.y ? 3 : 2;
  for (int i = 0; i < 2 * across; ++i) {
    const double part = static_cast<double>(i % across) / (across - 1);
    const double x = picture.low.x + 0.7 * side + part * (size.x - 1.4 * side);
    const double y = i < across ? picture.low.y - 0.85 * side : picture.high.y + 0.85 * side;
    const glm::dvec2 jitter(random.between(-10, 10), random.between(-5, 5));
    rig.markers.push_back(
        {i, {decimals(x + jitter.x, 1), decimals(y + jitter.y, 1)}, side, decimals(random.between(-3, 3), 1)});
  }
}

/// The screen reaches a little beyond everything, and its top-left corner becomes the wall's origin.
void addScreen(Rig& rig) {
  constexpr double kMargin = 60;
  WallBounds all = boundsOf(rig);
  for (const auto& marker : rig.markers) {
    all.include(marker.centre - 0.75 * marker.side);
    all.include(marker.centre + 0.75 * marker.side);
  }
  const glm::dvec2 origin(std::floor(all.low.x - kMargin), std::floor(all.low.y - kMargin));
  rig.screenTopLeft = {0, 0};
  rig.screenSize = {std::ceil(all.high.x + kMargin - origin.x), std::ceil(all.high.y + kMargin - origin.y)};
  for (auto& marker : rig.markers) {
    marker.centre = {decimals(marker.centre.x - origin.x, 1), decimals(marker.centre.y - origin.y, 1)};
  }
  for (auto& projector : rig.projectors) {
    projector.pose.position = decimals(projector.pose.position - glm::dvec3(origin, 0), 1);
  }
}

/// A projector where it is meant to be, but for `slack`.
void addPlaced(Rig& rig, SimulatedProjectorSpec spec, const Place& place, double slack, Random& random) {
  spec.name = fmt::format("p{}", rig.projectors.size() + 1);
  aim(spec, place, slack, random);
  rig.projectors.push_back(std::move(spec));
}

Rig finished(Rig rig, Random& random) {
  addMarkers(rig, random);
  addScreen(rig);
  placeCamera(rig);
  return rig;
}

}  // namespace

Rig casualRig(int columns, int rows, devices::Size resolution, std::uint32_t seed, devices::Size cameraSize) {
  assert(columns > 0 && rows > 0);
  Random random(seed);
  Rig rig;
  rig.seed = seed;
  rig.camera.size = cameraSize;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) addProjector(rig, column, row, columns, resolution, random);
  }
  return finished(std::move(rig), random);
}

Rig reportRig(std::uint32_t seed) {
  return casualRig(4, 2, {1024, 768}, seed);
}

Rig miniRig(std::uint32_t seed) {
  return casualRig(2, 1, {640, 480}, seed, {960, 600});
}

Rig stackedRig(std::uint32_t seed) {
  Random random(seed);
  Rig rig{.seed = seed};
  constexpr devices::Size kResolution{1024, 768};
  const double step = (1 - kOverlap) * kFrameWidth;
  for (int layer = 0; layer < 2; ++layer) {
    for (const glm::dvec2 cell : kTwoByTwo) {
      const glm::dvec2 target = step * cell * glm::dvec2(1, 0.75);
      addPlaced(rig, drawProjector(random, kResolution, ""), {target}, 0.5, random);
    }
  }
  return finished(std::move(rig), random);
}

Rig portraitRig(std::uint32_t seed) {
  Random random(seed);
  Rig rig{.seed = seed};
  constexpr devices::Size kResolution{1024, 768};
  const double step = (1 - kOverlap) * 0.75 * kFrameWidth;
  for (int i = 0; i < 3; ++i) {
    // Some people turn a projector to the left, some to the right.
    addPlaced(rig, drawProjector(random, kResolution, ""), {{step * i, 0}, kFrameWidth, i == 1 ? -90.0 : 90.0}, 0.5,
              random);
  }
  return finished(std::move(rig), random);
}

Rig shortThrowRig(std::uint32_t seed) {
  Random random(seed);
  Rig rig{.seed = seed};
  constexpr devices::Size kResolution{1280, 800};
  const double step = (1 - kOverlap) * kFrameWidth;
  for (const glm::dvec2 cell : kTwoByTwo) {
    auto spec = drawProjector(random, kResolution, "");
    spec.optics.focal = decimals(kResolution.width * random.between(0.78, 0.85), 1);
    // Shifted by half a frame: from a table upwards, from the ceiling downwards.
    spec.optics.principal.y = cell.y * kResolution.height;
    spec.optics.radial = {decimals(random.between(-0.15, -0.1), 4), decimals(random.between(0.03, 0.05), 4), 0};
    const glm::dvec2 target = step * cell * glm::dvec2(1, 0.625);
    addPlaced(rig, std::move(spec), {target}, 0.4, random);
  }
  return finished(std::move(rig), random);
}

Rig insetRig(std::uint32_t seed) {
  Random random(seed);
  Rig rig{.seed = seed};
  constexpr devices::Size kResolution{1024, 768};
  addPlaced(rig, drawProjector(random, kResolution, ""), {}, 1, random);
  const glm::dvec2 target{random.between(-250, 250), random.between(-150, 150)};
  addPlaced(rig, drawProjector(random, kResolution, ""), {target, kFrameWidth / 3}, 1, random);
  return finished(std::move(rig), random);
}

}  // namespace pixelflex::calib
