#pragma once

#include <string>
#include <vector>

#include "calib/capture/photographs.h"
#include "calib/estimate/collineation.h"
#include "calib/procedure/progress.h"
#include "calib/store/calibration.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// The fiducials as one photograph shows them.
struct SeenFiducials {
  std::string photo;               // the file, for messages; empty when a person gave all pixels
  std::vector<std::string> names;  // of the pairs
  std::vector<PointPair> pairs;    // undistorted camera pixel to wall
  std::string missing;             // names of those not found, by commas
};

/// In the photograph from the camera's chosen place; fiducials whose pixels a person gave need no photograph and are of
/// the first place. Throws ProcedureError, CaptureError.
[[nodiscard]] SeenFiducials findFiducials(const Wall& wall, const CameraIntrinsics& camera, Photographs* source,
                                          int place);

/// Report 5.1.2: the wall as the camera sees it from one place. Throws ProcedureError saying what is wrong with the
/// fiducials: too few, mistyped, or on a screen that is not flat.
[[nodiscard]] SurfaceFit measureSurface(const Surface& surface, const CameraIntrinsics& camera,
                                        const SeenFiducials& seen, Progress& progress);

}  // namespace pixelflex::calib
