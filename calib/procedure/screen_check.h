#pragma once

#include <string>
#include <vector>

#include "calib/procedure/surface_step.h"

namespace pixelflex::calib {

/// A screen that was said to be flat but bows by more than half a per cent of the width looked at is refused, with the
/// bow and what to write instead: ProcedureError. From six or more fiducials:
void refuseBentFiducials(const Surface& surface, const CameraIntrinsics& camera, const SeenFiducials& seen);

/// and from a projector's points (projector pixel to undistorted camera pixel).
void refuseBentPicture(const Surface& surface, const CameraIntrinsics& camera, const std::string& projector,
                       const std::vector<PointPair>& points, devices::Size resolution,
                       const std::vector<PointPair>& fiducials);

}  // namespace pixelflex::calib
