#pragma once

#include "calib/capture/photographs.h"
#include "calib/procedure/progress.h"
#include "calib/store/calibration.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// Report 5.1.1: intrinsics from photographs of the checkerboard, or those that are known. Throws ProcedureError.
[[nodiscard]] CameraIntrinsics measureCamera(const CameraSource& camera, Photographs& source, Progress& progress);

}  // namespace pixelflex::calib
