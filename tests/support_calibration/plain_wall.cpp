#include "tests/support_calibration/plain_wall.h"

#include "calib/procedure/procedure.h"

namespace pixelflex::calib {
namespace {

constexpr int kSide = 1000;
constexpr int kStep = 850;

ProjectorCalibration square(const std::string& name, int left) {
  ProjectorCalibration projector{.name = name, .resolution = {kSide, kSide}};
  projector.model.projectorFromWall = {1, 0, -double(left), 0, 1, 0, 0, 0, 1};
  for (int i = 0; i < 100; ++i) {
    const glm::dvec2 p(50 + 100 * (i % 10), 50 + 100 * static_cast<int>(i / 10));
    projector.samples.push_back({p, p + glm::dvec2(left, 0)});
  }
  projector.quality = {.rms = 0.02,
                       .p95 = 0.04,
                       .maximum = 0.06,
                       .found = 100,
                       .shown = 100,
                       .heldOut = 0.022,
                       .deviation = 0.01,
                       .cameraScale = 1};
  return projector;
}

}  // namespace

PlainWall::PlainWall(int projectors) {
  for (int i = 0; i < projectors; ++i) {
    ProjectorConfig config;
    config.name = "p" + std::to_string(i + 1);
    config.resolution = {kSide, kSide};
    wall.projectors.push_back(config);
    calibration.projectors.push_back(square(config.name, i * kStep));
  }
  const int right = kStep * (projectors - 1) + kSide;
  for (int i = 0; i < 6; ++i) {
    wall.surface.fiducials.push_back(
        {.aruco = i, .pointInCamera = {}, .pointInWall = {i % 3 * right / 2.0, i < 3 ? -40.0 : kSide + 40.0}});
  }
  calibration.camera = CameraIntrinsics{
      .size = {right + 200, kSide + 100}, .fx = 3000, .fy = 3000, .cx = 1000, .cy = 500, .rmsPx = 0.03, .photos = 15};
  calibration.surface = SurfaceFit{.wallFromCamera = {1, 0, -100, 0, 1, -50, 0, 0, 1}, .rms = 0.1};
  calibration.display = Display{10, 10, right - 10.0, kSide - 10.0, {right - 20, kSide - 20}};
  for (const auto& step : stepNames()) calibration.steps[step] = "done";
}

}  // namespace pixelflex::calib
