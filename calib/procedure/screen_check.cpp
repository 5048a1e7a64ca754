#include "calib/procedure/screen_check.h"

#include <cmath>

#include "calib/estimate/bent_screen.h"
#include "calib/procedure/procedure_error.h"
#include "calib/procedure/wording.h"

namespace pixelflex::calib {
namespace {

constexpr double kFlatEnough = 0.005;  // bow over width: what a slack screen may have

std::string cure(const Surface& surface, const Bow& bow) {
  return "; write shape: {cylinder: {radius: " + rounded(std::abs(bow.radius), 0) +
         "}} with the radius that you measure and the fiducials' places along the screen, or shape: camera (right from "
         "where the camera stands), into wall.yaml (all lengths in " +
         surface.units + ")";
}

std::string describe(const Surface& surface, const Bow& bow) {
  return "the screen is not flat: it bows by about " + rounded(std::abs(bow.height), 0) + " " + surface.units +
         (bow.height < 0 ? " towards the audience" : "") + " over " + rounded(bow.width, 0) + " " + surface.units +
         " (a radius of about " + rounded(std::abs(bow.radius), 0) + ")";
}

bool flatEnough(const Bow& bow) {
  return std::abs(bow.height) < kFlatEnough * bow.width;
}

}  // namespace

void refuseBentFiducials(const Surface& surface, const CameraIntrinsics& camera, const SeenFiducials& seen) {
  const auto bow = bowOfFiducials(seen.pairs, camera);
  // Within what a tape measure gives, a plane is as good.
  if (!bow || flatEnough(*bow) || bow->flatError < 0.002 * bow->width) return;
  throw ProcedureError(seen.photo + ": " + describe(surface, *bow) + ": the fiducials miss a plane by " +
                       rounded(bow->flatError, 1) + " " + surface.units + ", a cylinder by " +
                       rounded(bow->bentError, 1) + cure(surface, *bow));
}

void refuseBentPicture(const Surface& surface, const CameraIntrinsics& camera, const std::string& projector,
                       const std::vector<PointPair>& points, devices::Size resolution,
                       const std::vector<PointPair>& fiducials) {
  const auto bow = bowOfProjector(points, resolution, fiducials, camera);
  if (!bow || flatEnough(*bow)) return;
  throw ProcedureError("projector " + projector + ": " + describe(surface, *bow) + ": its picture misses a plane by " +
                       rounded(bow->flatError, 2) + " px, a bent screen by " + rounded(bow->bentError, 2) +
                       cure(surface, *bow));
}

}  // namespace pixelflex::calib
