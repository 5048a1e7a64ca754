#include "calib/simulate/camera_fit.h"

#include <algorithm>
#include <cmath>

#include "calib/simulate/projector_light.h"
#include "calib/simulate/stage.h"

namespace pixelflex::calib {

namespace {

constexpr double kBorder = 40;  // camera pixels

std::vector<glm::dvec2> mustSee(const Rig& rig) {
  auto points = frameOutlines(rig);
  for (const auto& marker : rig.markers) {
    for (const double x : {-0.75, 0.75}) {
      for (const double y : {-0.75, 0.75}) points.push_back(marker.centre + marker.side * glm::dvec2(x, y));
    }
  }
  return points;
}

struct Extent {
  WallBounds pixels;
  bool all = true;
};

Extent extentOf(const SimulatedCameraSpec& camera, const Screen& screen, const std::vector<glm::dvec2>& points) {
  const PlacedOptics optics(camera.pose, camera.optics);
  Extent extent;
  for (const glm::dvec2 point : points) {
    const auto pixel = optics.pixelFromWall(screen, point);
    extent.all = extent.all && pixel.has_value();
    if (pixel) extent.pixels.include(*pixel);
  }
  return extent;
}

}  // namespace

Optics wideLens(devices::Size size) {
  Optics optics;
  optics.focal = std::round(0.83 * size.width);
  optics.principal = {std::round(0.5 * size.width + 0.006 * size.width),
                      std::round(0.5 * size.height - 0.008 * size.height)};
  optics.radial = {-0.1, 0.03, 0};
  optics.tangential = {0.0006, -0.0004};
  return optics;
}

std::vector<glm::dvec2> frameOutlines(const Rig& rig) {
  constexpr int kSteps = 16;
  const auto screen = makeScreen(rig);
  std::vector<glm::dvec2> points;
  for (const auto& spec : rig.projectors) {
    const ProjectorLight light(spec, *screen);
    const glm::dvec2 size(spec.resolution.width, spec.resolution.height);
    for (int i = 0; i <= kSteps; ++i) {
      const double t = static_cast<double>(i) / kSteps;
      for (const glm::dvec2 part : {glm::dvec2(t, 0), glm::dvec2(t, 1), glm::dvec2(0, t), glm::dvec2(1, t)}) {
        if (const auto wall = light.wallFromPixel(part * size)) points.push_back(*wall);
      }
    }
  }
  return points;
}

void placeCamera(Rig& rig) {
  auto& camera = rig.camera;
  camera.optics = wideLens(camera.size);
  camera.pose.rotation = {6, -5, 0.8};
  const auto screen = makeScreen(rig);
  const auto points = mustSee(rig);
  const glm::dvec2 size(camera.size.width, camera.size.height);
  const glm::dvec3 along = roomFromDevice(camera.pose.rotation) * glm::dvec3(0, 0, 1);
  glm::dvec2 target = 0.5 * (rig.screenTopLeft + rig.screenTopLeft + rig.screenSize);
  double distance = 3 * std::max(rig.screenSize.x, rig.screenSize.y);  // far enough to see everything
  for (int step = 0; step < 60; ++step) {
    camera.pose.position = glm::dvec3(target, 0) - along * distance;
    const Extent extent = extentOf(camera, *screen, points);
    const glm::dvec2 span = extent.pixels.high - extent.pixels.low;
    const glm::dvec2 off = 0.5 * (extent.pixels.low + extent.pixels.high) - 0.5 * size;
    const double fill = std::max(span.x / (size.x - 2 * kBorder), span.y / (size.y - 2 * kBorder));
    target += off * (distance / camera.optics.focal);
    distance *= extent.all ? std::clamp(fill, 0.7, 1.3) : 1.3;
  }
  camera.pose.position = glm::round(camera.pose.position);
}

}  // namespace pixelflex::calib
