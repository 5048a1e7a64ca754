#include "calib/simulate/rig_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "calib/simulate/planar_screen.h"

namespace pixelflex::calib {

namespace {

constexpr double kScreenMargin = 60;  // mm around everything

double rounded(double value, double step) {
  return std::round(value / step) * step;
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

}  // namespace

double decimals(double value, int places) {
  const double scale = std::pow(10.0, places);
  return std::round(value * scale) / scale;
}

glm::dvec3 decimals(glm::dvec3 value, int places) {
  return {decimals(value.x, places), decimals(value.y, places), decimals(value.z, places)};
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

HandAim drawAim(devices::Size resolution, const Place& place, double slack, Random& random) {
  const double width = place.width;
  const double height = width * resolution.height / resolution.width;
  const glm::dvec3 turn(random.between(-8, 8), random.between(-8, 8), random.between(-2.5, 2.5));
  HandAim aim;
  aim.turn = slack * turn + glm::dvec3(0, 0, place.roll);
  aim.target = place.target + slack * 0.03 * glm::dvec2(random.between(-width, width), random.between(-height, height));
  aim.area = width * height * (1 + slack * random.between(-0.03, 0.03));
  return aim;
}

void aim(SimulatedProjectorSpec& spec, const Place& place, double slack, Random& random) {
  const HandAim hand = drawAim(spec.resolution, place, slack, random);
  const glm::dvec2 size(spec.resolution.width, spec.resolution.height);
  spec.pose.rotation = decimals(hand.turn, 2);
  const PlanarScreen screen;
  const auto along = PlacedOptics(spec.pose, spec.optics).direction(0.5 * size).value_or(glm::dvec3(0, 0, 1));
  spec.pose.position = glm::dvec3(hand.target, 0) - along * place.width;
  // On a plane the lit area grows with the square of the distance.
  const double scale = std::sqrt(hand.area / litArea(ProjectorLight(spec, screen)));
  spec.pose.position = decimals(glm::dvec3(hand.target, 0) - along * (place.width * scale), 1);
}

void addPlaced(Rig& rig, SimulatedProjectorSpec spec, const Place& place, double slack, Random& random) {
  spec.name = nextName(rig);
  aim(spec, place, slack, random);
  rig.projectors.push_back(std::move(spec));
}

std::string nextName(const Rig& rig) {
  return fmt::format("p{}", rig.projectors.size() + 1);
}

WallBounds boundsOfFrames(const Rig& rig) {
  WallBounds bounds;
  for (const glm::dvec2 point : frameOutlines(rig)) bounds.include(point);
  return bounds;
}

WallBounds boundsOfScreen(const Rig& rig) {
  WallBounds all = boundsOfFrames(rig);
  for (const auto& marker : rig.markers) {
    all.include(marker.centre - 0.75 * marker.side);
    all.include(marker.centre + 0.75 * marker.side);
  }
  return {glm::floor(all.low - kScreenMargin), all.high + kScreenMargin};
}

double markerSide(double width, double cameraPixels) {
  return rounded(58 * width / cameraPixels, 5);
}

void addMarker(Rig& rig, glm::dvec2 centre, double side, Random& random) {
  const glm::dvec2 jitter(random.between(-10, 10), random.between(-5, 5));
  rig.markers.push_back({static_cast<int>(rig.markers.size()),
                         {decimals(centre.x + jitter.x, 1), decimals(centre.y + jitter.y, 1)},
                         side,
                         decimals(random.between(-3, 3), 1)});
}

void addMarkerRows(Rig& rig, int across, double side, Random& random) {
  const WallBounds picture = boundsOfFrames(rig);
  const glm::dvec2 size = picture.high - picture.low;
  for (int i = 0; i < 2 * across; ++i) {
    const double part = static_cast<double>(i % across) / (across - 1);
    const double x = picture.low.x + 0.7 * side + part * (size.x - 1.4 * side);
    const double y = i < across ? picture.low.y - 0.85 * side : picture.high.y + 0.85 * side;
    addMarker(rig, {x, y}, side, random);
  }
}

void moveOrigin(Rig& rig, glm::dvec2 origin) {
  for (auto& marker : rig.markers) {
    marker.centre = {decimals(marker.centre.x - origin.x, 1), decimals(marker.centre.y - origin.y, 1)};
  }
  for (auto& projector : rig.projectors) {
    projector.pose.position = decimals(projector.pose.position - glm::dvec3(origin, 0), 1);
  }
}

void addPlanarScreen(Rig& rig) {
  const WallBounds all = boundsOfScreen(rig);
  rig.screenTopLeft = {0, 0};
  rig.screenSize = glm::ceil(all.high - all.low);
  moveOrigin(rig, all.low);
}

Rig finished(Rig rig, Random& random) {
  const WallBounds picture = boundsOfFrames(rig);
  const glm::dvec2 size = picture.high - picture.low;
  const double pixelsAcross = std::min(rig.camera.size.width - 80.0, 1.4 * rig.camera.size.height * size.x / size.y);
  // Six on wide walls, four on narrow ones.
  addMarkerRows(rig, size.x > 2 * size.y ? 3 : 2, markerSide(size.x, pixelsAcross), random);
  addPlanarScreen(rig);
  placeCamera(rig);
  return rig;
}

}  // namespace pixelflex::calib
