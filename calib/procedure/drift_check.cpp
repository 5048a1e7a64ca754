#include "calib/procedure/drift_check.h"

#include <algorithm>
#include <set>

#include "calib/procedure/procedure_error.h"

namespace pixelflex::calib {
namespace {

/// A quarter of a pixel at a seam begins to show in text.
constexpr double kNoticeable = 0.25;

std::string verdictOn(const std::string& name, const Drift& drift) {
  const std::string cure = "; run pixelflex calibrate WALL --only " + name;
  if (drift.expected == 0) return "not in the camera's picture";
  if (isUnseen(drift)) return "nothing seen of it: is it on?";
  if (isFarOff(drift)) return "moved by more than half a blob's distance, or partly hidden" + cure;
  return drift.rms <= kNoticeable ? "in place" : "has moved" + cure;
}

const SurfaceFit& surfaceOf(const Calibration& calibration, int place) {
  if (place == 0) return *calibration.surface;
  const auto further = static_cast<std::size_t>(place) - 1;
  if (further < calibration.places.size()) return calibration.places[further];
  throw ProcedureError("the wall was measured from fewer camera places: photograph it from the same ones");
}

Drift driftOf(const ProjectorCalibration& projector, const Calibration& calibration, const CameraMapping& camera,
              const ScreenView& screen, Photographs& photographs) {
  const BlobLayout layout(projector.resolution);
  const ProjectedPattern pattern = projected(Pattern::kBlobs, layout);
  const auto photo = photographs.pattern(projector.name, pattern);
  if (photo.size() != calibration.camera->size) {
    throw ProcedureError(patternPath(projector.name, pattern).string() +
                         ": not of the size that the camera was calibrated at");
  }
  return measureDrift(photo, layout, camera, screen, ProjectorMapping(projector.model, projector.resolution));
}

}  // namespace

bool isUnseen(const Drift& drift) {
  return drift.expected == 0 || drift.found < drift.expected / 10;
}

bool isFarOff(const Drift& drift) {
  return drift.found < drift.expected * 9 / 10;
}

std::vector<ProjectorDrift> checkDrift(const Calibration& calibration, Photographs& photographs,
                                       const std::vector<std::string>& only, Progress& progress) {
  if (!calibration.camera || !calibration.surface || calibration.projectors.empty()) {
    throw ProcedureError("nothing to compare with: run pixelflex calibrate WALL");
  }
  const CameraMapping camera(*calibration.camera);
  std::vector<ProjectorDrift> drifts;
  std::set<std::string> seen;
  const auto wanted = [&](const std::string& name) {
    return (only.empty() || std::ranges::find(only, name) != only.end()) && !seen.contains(name);
  };
  progress.beginStep("check");
  for (int place = 0; place < photographs.placeCount(); ++place) {
    photographs.choosePlace(place);
    const ScreenView screen(surfaceOf(calibration, place));
    for (const auto& projector : calibration.projectors) {
      if (!wanted(projector.name) || !photographs.hasProjector(projector.name)) continue;
      const Drift drift = driftOf(projector, calibration, camera, screen, photographs);
      // From one of several places a projector may lie outside the picture; another will show it.
      if (drift.expected < kBlobCount / 2 && place + 1 < photographs.placeCount()) continue;
      seen.insert(projector.name);
      drifts.push_back({projector.name, drift, verdictOn(projector.name, drift)});
      progress.advance(static_cast<int>(drifts.size()), static_cast<int>(calibration.projectors.size()),
                       projector.name);
    }
  }
  for (const auto& projector : calibration.projectors) {
    if (wanted(projector.name)) progress.warn("projector " + projector.name + ": nothing was photographed of it");
  }
  progress.endStep(std::to_string(drifts.size()) + " projectors photographed; nothing was changed");
  return drifts;
}

}  // namespace pixelflex::calib
