#include "tests/support_calibration/calibrated_rig.h"

#include "calib/capture/live_photographs.h"
#include "devices/image/atomic_file.h"

namespace pixelflex::calib {

CalibratedRig calibrateRig(SimulatedWall& room, const std::filesystem::path& folder, std::optional<Method> method,
                           const Blend& blend) {
  CalibratedRig result;
  result.wall = wallOfRig(room.rig(), "rig.yaml");
  result.wall.blend = blend;
  std::vector<devices::Projector*> projectors;
  for (std::size_t i = 0; i < room.projectorCount(); ++i) projectors.push_back(&room.projector(i));
  for (std::size_t i = 0; i < room.projectorCount(); ++i) {
    const auto& projector = room.rig().projectors[i];
    const auto noise = room.rig().seed + static_cast<std::uint32_t>(i);  // every projector's own
    devices::writeFileAtomically(folder / "readings" / (projector.name + ".csv"),
                                 readingsOfProjector(projector, noise));
  }
  saveWall(folder, result.wall);
  LivePhotographs photographs(room.camera(), projectors, room.person(), folder / "captures", "test",
                              room.rig().checkerboardPoses, room.placeCount());
  RecordedProgress progress;
  Procedure procedure(folder, result.wall, {}, &photographs, progress);
  procedure.run({.method = method, .goOnWithoutFailed = true});
  procedure.save();
  result.calibration = procedure.calibration();
  result.warnings = progress.warnings;
  return result;
}

}  // namespace pixelflex::calib
