#include "tests/gl/bent_frames.h"

#include <algorithm>
#include <cmath>

#include "calib/geometry/patch_mesh.h"

namespace pixelflex::testing {

calib::ProjectorCalibration projectorOf(Model kind) {
  calib::ProjectorCalibration projector{.name = "p1", .resolution = kFrame};
  auto& model = projector.model;
  model = {.projectorFromWall = {1.0e-3, 6e-5, -0.55, -4e-5, 0.98e-3, -0.38, 5e-5, 3e-5, 1},
           .centre = {530, 350},
           .scale = 1024};
  const bool all = kind == Model::kAll;
  if (kind == Model::kShortThrow || all) {
    model.radial = {-0.15, 0.03, 0};
    model.tangential = {5e-4, -3e-4};
  }
  if (kind == Model::kBent || all) model.bend = calib::Bend{.radius = 3000, .apex = 500, .depth = {2e-5, 5e-5, 3e-4}};
  if (kind == Model::kResidual || all) {
    calib::ResidualSpline spline{.columns = 4, .rows = 3, .control = {}};
    for (int i = 0; i < 42; ++i) spline.control.emplace_back(0.8 * std::sin(1.7 * i), 0.6 * std::cos(2.3 * i));
    model.residual = spline;
  }
  if (kind == Model::kNudged || all) {
    projector.nudge = calib::Nudge{
        .shift = {1.37, -2.71}, .roll = 0.3, .corners = {{{3.1, 0.4}, {-1.2, 0.9}, {0.3, -2.2}, {1.9, 1.1}}}};
  }
  return projector;
}

calib::Display displayOf(Place place) {
  if (place == Place::kFrameInsideDisplay) return {-500, -400, 1900, 1400, {2400, 1800}};
  return {103, 81.5, 897, 702, {1600, 1251}};
}

double depthInDisplay(const calib::ProjectorMapping& mapping, const calib::Display& display, int x, int y) {
  const auto inWall = mapping.wallFromProjector({x + 0.5, y + 0.5});
  if (!inWall) return -1e9;
  const glm::dvec2 p = calib::desktopFromWall(display).map(*inWall);
  return std::min({p.x, p.y, display.resolution.width - p.x, display.resolution.height - p.y});
}

}  // namespace pixelflex::testing
