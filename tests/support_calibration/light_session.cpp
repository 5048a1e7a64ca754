#include "tests/support_calibration/light_session.h"

#include <stdexcept>
#include <utility>

#include "calib/capture/folder_photographs.h"

namespace pixelflex::calib {

LightSession::LightSession(SimulatedWall& room, std::filesystem::path folder, const Blend& blend)
    : folder_(std::move(folder)), rig_(calibrateRig(room, folder_, Method::kBlobs, blend)) {
  if (rig_.calibration.projectors.size() != room.projectorCount()) {
    throw std::runtime_error("not every projector could be calibrated");
  }
}

void LightSession::match(const Blend& blend) {
  rig_.wall.blend = blend;
  FolderPhotographs photographs({folder_ / "captures"}, folder_ / "captures");
  RecordedProgress progress;
  Procedure procedure(folder_, rig_.wall, rig_.calibration, &photographs, progress);
  procedure.run({.steps = {"blend", "gamma"}, .method = Method::kBlobs});
  procedure.save();
  rig_.calibration = procedure.calibration();
}

}  // namespace pixelflex::calib
