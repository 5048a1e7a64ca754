#include "calib/procedure/geometry_step.h"

#include <algorithm>
#include <set>

#include "calib/estimate/joint_solve.h"
#include "calib/estimate/projector_fit.h"
#include "calib/geometry/screen_view.h"
#include "calib/procedure/procedure_error.h"
#include "calib/procedure/screen_check.h"

namespace pixelflex::calib {

std::vector<SurfaceFit> solveSurfaces(const std::vector<SeenProjector>& seen,
                                      std::vector<std::vector<PointPair>> fiducials) {
  JointProblem problem;
  problem.fiducials = std::move(fiducials);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    problem.resolutions.push_back(seen[i].config->resolution);
    for (const auto& view : seen[i].views) problem.observations.push_back({view.place, i, view.points});
  }
  try {
    return solvePlaces(problem);
  } catch (const EstimateError& error) {
    throw ProcedureError(std::string("camera places: ") + error.what());
  }
}

ProjectorCalibration calibrateProjector(const SeenProjector& seen, const std::vector<SurfaceFit>& surfaces) {
  ProjectorCalibration projector{.name = seen.config->name, .resolution = seen.config->resolution};
  std::set<std::pair<double, double>> distinct;
  double scale = 0;
  std::optional<BentScreen> screen;
  for (const auto& seenFrom : seen.views) {
    const SurfaceFit& surface = surfaces.at(seenFrom.place);
    if (surface.bend) screen = BentScreen{surface.bend->radius, surface.bend->apex};
    const ScreenView view(surface);
    for (const auto& point : seenFrom.points) {
      const auto inWall = view.wallFromImage(point.target);
      if (!inWall) throw EstimateError("its picture misses the screen: is the radius right?");
      projector.samples.push_back({point.source, *inWall});
      distinct.emplace(point.source.x, point.source.y);
    }
    scale = std::max(scale, seenFrom.cameraScale);
  }
  const ProjectorFit fit = fitProjector(projector.samples, projector.resolution, screen);
  projector.model = fit.model;
  projector.quality = fit.quality;
  projector.quality.found = static_cast<int>(distinct.size());
  projector.quality.shown = seen.shown;
  projector.quality.cameraScale = scale;
  return projector;
}

void checkFlatness(const Surface& surface, const CameraIntrinsics& camera, const SurfaceFit& plane,
                   const SeenProjector& seen, const ProjectorCalibration& fitted) {
  constexpr double kWellFitted = 0.15;  // px: no need to ask further
  if (surface.shape != SurfaceShape::kPlanar) return;
  if (!fitted.model.residual && fitted.quality.rms < kWellFitted) return;
  const ScreenView view(plane);
  std::vector<PointPair> fiducials;
  for (const auto& fiducial : surface.fiducials) {
    fiducials.push_back({view.imageFromWall(fiducial.pointInWall), fiducial.pointInWall});
  }
  refuseBentPicture(surface, camera, fitted.name, seen.views.front().points, fitted.resolution, fiducials);
}

}  // namespace pixelflex::calib
