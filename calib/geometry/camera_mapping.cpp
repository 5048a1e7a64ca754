#include "calib/geometry/camera_mapping.h"

namespace pixelflex::calib {

CameraMapping::CameraMapping(const CameraIntrinsics& intrinsics)
    : lens_(intrinsics.radial, intrinsics.tangential),
      focal_(intrinsics.fx, intrinsics.fy),
      centre_(intrinsics.cx, intrinsics.cy) {}

glm::dvec2 CameraMapping::undistortedFromRaw(glm::dvec2 pointInRaw) const {
  const auto ideal = lens_.undistort((pointInRaw - centre_) / focal_);
  return ideal ? *ideal * focal_ + centre_ : pointInRaw;
}

glm::dvec2 CameraMapping::rawFromUndistorted(glm::dvec2 pointInUndistorted) const {
  return lens_.distort((pointInUndistorted - centre_) / focal_) * focal_ + centre_;
}

}  // namespace pixelflex::calib
