#include "tests/support_calibration/light_session.h"

#include <stdexcept>
#include <utility>

#include "calib/capture/folder_photographs.h"
#include "calib/capture/live_photographs.h"
#include "calib/procedure/procedure_error.h"
#include "calib/procedure/response_step.h"

namespace pixelflex::calib {

LightSession::LightSession(SimulatedWall& room, std::filesystem::path folder, const Blend& blend)
    : room_(room), folder_(std::move(folder)), rig_(calibrateRig(room, folder_, Method::kBlobs, blend)) {
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

ResponseCurve LightSession::responseByCamera(std::size_t projector) {
  Wall wall = rig_.wall;
  wall.projectors.at(projector).gamma.reset();
  wall.projectors.at(projector).gammaByCamera = true;
  const std::string& name = wall.projectors.at(projector).name;
  std::vector<devices::Projector*> projectors;
  for (std::size_t i = 0; i < room_.projectorCount(); ++i) projectors.push_back(&room_.projector(i));
  LivePhotographs photographs(room_.camera(), projectors, room_.person(), {}, "test", 0, room_.placeCount());
  RecordedProgress progress;
  auto result = measureResponses(wall, rig_.calibration, {name}, photographs, progress,
                                 [](const std::string&, const std::string& problem) { throw ProcedureError(problem); });
  return result.responses.at(name).curve;
}

}  // namespace pixelflex::calib
