// The steps of Procedure that find out where every pixel lands.
#include "calib/procedure/procedure.h"

#include <algorithm>
#include <utility>

#include "calib/procedure/camera_step.h"
#include "calib/procedure/display_step.h"
#include "calib/procedure/geometry_step.h"
#include "calib/procedure/surface_step.h"
#include "calib/procedure/wording.h"

namespace pixelflex::calib {

std::string Procedure::runCamera() {
  auto& source = photographs("camera");
  tookPhotographs_ = true;
  const auto response = calibration_.camera ? calibration_.camera->response : std::nullopt;
  calibration_.camera = measureCamera(wall_.camera, source, progress_);
  calibration_.camera->response = response;
  const CameraIntrinsics& camera = knownCamera();
  if (camera.photos == 0) return "known intrinsics, " + sizeText(camera.size);
  return count(static_cast<std::size_t>(camera.photos), "photograph") + ", reprojection " + rounded(camera.rmsPx, 3) +
         " px RMS";
}

std::string Procedure::runSurface() {
  calibration_.places.clear();
  if (wall_.surface.shape == SurfaceShape::kCamera) {
    calibration_.surface = SurfaceFit{};
    return "as the camera sees it";
  }
  tookPhotographs_ = tookPhotographs_ || photographs_ != nullptr;
  if (photographs_ != nullptr && photographs_->placeCount() > 1) {
    // Solved with the projectors, which tie the places together; until then nothing is known.
    calibration_.surface = SurfaceFit{};
    return count(static_cast<std::size_t>(photographs_->placeCount()), "camera place") + ", solved with the projectors";
  }
  const SeenFiducials seen = findFiducials(wall_, knownCamera(), photographs_, 0);
  calibration_.surface = measureSurface(wall_.surface, knownCamera(), seen, progress_);
  return count(seen.pairs.size(), "fiducial") + ", fit " + rounded(calibration_.surface->rms, 3) + " " +
         wall_.surface.units + " RMS";
}

std::vector<const ProjectorConfig*> Procedure::wantedProjectors() const {
  std::vector<const ProjectorConfig*> wanted;
  for (const auto& config : wall_.projectors) {
    if (options_.skip.contains(config.name)) continue;
    if (options_.only.empty() || options_.only.contains(config.name)) wanted.push_back(&config);
  }
  return wanted;
}

std::string Procedure::runProjectors() {
  auto& source = photographs("projectors");
  tookPhotographs_ = true;
  const auto wanted = wantedProjectors();
  const std::vector<ProjectorCalibration> before = calibration_.projectors;
  std::erase_if(calibration_.projectors,
                [&](const auto& known) { return options_.only.empty() || options_.only.contains(known.name); });
  const std::size_t kept = calibration_.projectors.size();
  ProjectorStep step(knownCamera(), method_, source, progress_,
                     [this](const std::string& name, const std::string& problem) { reportFailure(name, problem); });
  const auto seen = step.observe(wanted);
  if (seen.empty()) throw ProcedureError("no projector could be calibrated");
  const auto surfaces = surfacesFor(seen);
  for (const auto& projector : seen) addProjector(projector, surfaces);
  for (const auto& known : before) keepLight(known);
  if (calibration_.projectors.size() == kept) throw ProcedureError("no projector could be calibrated");
  std::ranges::sort(calibration_.projectors, {}, [&](const ProjectorCalibration& p) {
    return std::ranges::find(wall_.projectors, p.name, &ProjectorConfig::name) - wall_.projectors.begin();
  });
  return count(calibration_.projectors.size() - kept, "projector") + " of " + std::to_string(wanted.size());
}

/// Repairs measure against the surfaces that are stored; so does everything from a single place.
std::vector<SurfaceFit> Procedure::surfacesFor(const std::vector<SeenProjector>& seen) {
  const auto places = static_cast<std::size_t>(photographs("projectors").placeCount());
  if (places == 1) return {knownSurfaces().front()};
  if (!options_.only.empty()) {
    if (knownSurfaces().size() != places) {
      throw ProcedureError("the wall was measured from " + count(knownSurfaces().size(), "camera place") + ", not " +
                           std::to_string(places) + ": photograph it again from the same places, or all of it");
    }
    return knownSurfaces();
  }
  std::vector<std::vector<PointPair>> fiducials;
  for (std::size_t place = 0; place < places; ++place) {
    photographs_->choosePlace(static_cast<int>(place));
    const bool any = photographs_->hasFiducials();
    fiducials.push_back(any ? findFiducials(wall_, knownCamera(), photographs_, static_cast<int>(place)).pairs
                            : std::vector<PointPair>{});
    progress_.advance(static_cast<int>(place) + 1, static_cast<int>(places), "fiducials");
  }
  auto surfaces = solveSurfaces(seen, std::move(fiducials));
  calibration_.surface = surfaces.front();
  calibration_.places.assign(surfaces.begin() + 1, surfaces.end());
  return surfaces;
}

/// Until it is measured again.
void Procedure::keepLight(const ProjectorCalibration& known) {
  const auto now = std::ranges::find(calibration_.projectors, known.name, &ProjectorCalibration::name);
  if (now == calibration_.projectors.end()) return;
  now->light = known.light;
  now->measured = known.measured;
}

void Procedure::addProjector(const SeenProjector& seen, const std::vector<SurfaceFit>& surfaces) {
  try {
    ProjectorCalibration projector = calibrateProjector(seen, surfaces);
    const SurfaceFit& surface = surfaces.at(seen.views.front().place);
    checkFlatness(wall_.surface, knownCamera(), surface, seen, projector);
    if (const auto nudge = nudges_.find(projector.name); nudge != nudges_.end()) projector.nudge = nudge->second;
    calibration_.projectors.push_back(std::move(projector));
  } catch (const EstimateError& error) {
    reportFailure(seen.config->name, error.what());
  }
}

void Procedure::reportFailure(const std::string& name, const std::string& problem) {
  const std::string message = "projector " + name + ": " + problem;
  if (!options_.goOnWithoutFailed) throw ProcedureError(message);
  progress_.warn(message + "; left out");
}

std::string Procedure::keepOrFindDisplay() {
  if (displayIsLit(calibration_)) return "desktop stays " + sizeText(knownDisplay().resolution);
  progress_.warn("the old display is not wholly lit any more; a new one was found");
  return runMesh();
}

std::string Procedure::runMesh() {
  calibration_.display = measureDisplay(wall_, calibration_);
  return "desktop " + sizeText(knownDisplay().resolution);
}

}  // namespace pixelflex::calib
