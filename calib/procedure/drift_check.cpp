#include "calib/procedure/drift_check.h"

#include <algorithm>

#include "calib/procedure/procedure.h"

namespace pixelflex::calib {
namespace {

/// A quarter of a pixel at a seam begins to show in text.
constexpr double kNoticeable = 0.25;

std::string verdictOn(const std::string& name, const Drift& drift) {
  const std::string cure = "; run pixelflex calibrate WALL --only " + name;
  if (drift.expected == 0) return "not in the camera's picture";
  if (drift.found < drift.expected / 10) return "nothing seen of it: is it on?";
  if (drift.found < drift.expected * 9 / 10)
    return "moved by more than half a blob's distance, or partly hidden" + cure;
  return drift.rms <= kNoticeable ? "in place" : "has moved" + cure;
}

}  // namespace

std::vector<ProjectorDrift> checkDrift(const Calibration& calibration, Photographs& photographs,
                                       const std::vector<std::string>& only, Progress& progress) {
  if (!calibration.camera || !calibration.surface || calibration.projectors.empty()) {
    throw ProcedureError("nothing to compare with: run pixelflex calibrate WALL");
  }
  const CameraMapping camera(*calibration.camera);
  const Homography wallFromCamera(calibration.surface->wallFromCamera);
  std::vector<ProjectorDrift> drifts;
  progress.beginStep("check");
  for (const auto& projector : calibration.projectors) {
    if (!only.empty() && std::ranges::find(only, projector.name) == only.end()) continue;
    if (!photographs.hasProjector(projector.name)) {
      progress.warn("projector " + projector.name + ": nothing was photographed of it");
      continue;
    }
    const BlobLayout layout(projector.resolution);
    const ProjectedPattern pattern = projected(Pattern::kBlobs, layout);
    const auto photo = photographs.pattern(projector.name, pattern);
    if (photo.size() != calibration.camera->size) {
      throw ProcedureError(patternPath(projector.name, pattern).string() +
                           ": not of the size that the camera was calibrated at");
    }
    const ProjectorMapping mapping(projector.model, projector.resolution);
    const Drift drift = measureDrift(photo, layout, camera, wallFromCamera, mapping);
    drifts.push_back({projector.name, drift, verdictOn(projector.name, drift)});
    progress.advance(static_cast<int>(drifts.size()), static_cast<int>(calibration.projectors.size()), projector.name);
  }
  progress.endStep(std::to_string(drifts.size()) + " projectors photographed; nothing was changed");
  return drifts;
}

}  // namespace pixelflex::calib
