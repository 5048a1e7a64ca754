#include "calib/procedure/camera_step.h"

#include "calib/estimate/intrinsics.h"
#include "calib/procedure/procedure_error.h"

namespace pixelflex::calib {
namespace {

std::vector<CheckerboardView> readViews(const Checkerboard& board, Photographs& source, Progress& progress,
                                        devices::Size& size) {
  std::vector<CheckerboardView> views;
  int seen = 0;
  // clang-tidy does not see that the loop is entered only with a photograph.
  // NOLINTBEGIN(bugprone-unchecked-optional-access)
  while (const auto shot = source.nextCheckerboard()) {
    if (seen > 0 && shot->photo.size() != size) {
      throw ProcedureError(shot->name + ": not of the same size as the photographs before it");
    }
    size = shot->photo.size();
    if (const auto corners = findCheckerboard(shot->photo, board)) {
      views.push_back({shot->name, *corners});
    } else {
      progress.warn(shot->name + ": no checkerboard of " + std::to_string(board.columns) + "x" +
                    std::to_string(board.rows) + " inner corners found; left out");
    }
    progress.advance(++seen, source.checkerboardCount(), "checkerboard");
  }
  // NOLINTEND(bugprone-unchecked-optional-access)
  if (seen == 0) {
    throw ProcedureError("no checkerboard photographs from " + source.checkerboardPlace() +
                         ", and no camera.yaml beside: about 15 photographs of the board are needed once per camera");
  }
  return views;
}

}  // namespace

CameraIntrinsics measureCamera(const CameraSource& camera, Photographs& source, Progress& progress) {
  if (const auto known = source.knownCamera()) return *known;
  const Checkerboard board = camera.checkerboard.value_or(Checkerboard{});
  devices::Size size;
  const auto views = readViews(board, source, progress, size);
  try {
    std::vector<std::string> remarks;
    const CameraIntrinsics measured = calibrateCamera(views, board, size, &remarks);
    for (const auto& remark : remarks) progress.warn("camera: " + remark);
    return measured;
  } catch (const EstimateError& error) {
    throw ProcedureError(std::string("camera: ") + error.what());
  }
}

}  // namespace pixelflex::calib
