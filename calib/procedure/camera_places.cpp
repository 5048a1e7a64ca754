#include "calib/procedure/camera_places.h"

#include "calib/geometry/camera_mapping.h"
#include "calib/procedure/procedure_error.h"

namespace pixelflex::calib {

ScreenView viewFromPlace(const Calibration& calibration, int place) {
  if (place == 0) return ScreenView(*calibration.surface);
  const auto further = static_cast<std::size_t>(place) - 1;
  if (further < calibration.places.size()) return ScreenView(calibration.places[further]);
  throw ProcedureError("the wall was measured from fewer camera places: photograph it from the same ones");
}

double seenShare(const ProjectorMapping& projector, const ScreenView& view, const CameraIntrinsics& camera) {
  constexpr int kSteps = 12;
  const CameraMapping mapping(camera);
  const devices::Size frame = projector.resolution();
  int seen = 0;
  for (int k = 0; k < kSteps * kSteps; ++k) {
    const glm::dvec2 part((k % kSteps + 0.5) / kSteps, (static_cast<int>(k / kSteps) + 0.5) / kSteps);
    const auto inWall = projector.wallFromProjector({part.x * frame.width, part.y * frame.height});
    if (!inWall) continue;
    const glm::dvec2 raw = mapping.rawFromUndistorted(view.imageFromWall(*inWall));
    if (raw.x > 0 && raw.y > 0 && raw.x < camera.size.width && raw.y < camera.size.height) ++seen;
  }
  return static_cast<double>(seen) / (kSteps * kSteps);
}

}  // namespace pixelflex::calib
