#pragma once

#include "calib/geometry/projector_mapping.h"
#include "calib/geometry/screen_view.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// The wall as the undistorted camera sees it from one of its places, counted from 0. Throws ProcedureError when the
/// wall was measured from fewer.
[[nodiscard]] ScreenView viewFromPlace(const Calibration& calibration, int place);

/// How much of a projector's frame lies in the camera's picture, 0..1.
[[nodiscard]] double seenShare(const ProjectorMapping& projector, const ScreenView& view,
                               const CameraIntrinsics& camera);

}  // namespace pixelflex::calib
