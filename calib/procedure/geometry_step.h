#pragma once

#include <string>
#include <vector>

#include "calib/procedure/projector_step.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// The wall from the camera's first place and its further ones, solved together from what several places saw of the
/// same projectors. `fiducials`: of each place. Throws ProcedureError.
[[nodiscard]] std::vector<SurfaceFit> solveSurfaces(const std::vector<SeenProjector>& seen,
                                                    std::vector<std::vector<PointPair>> fiducials);

/// A projector's model through its points, with `surfaces` of each place. Throws EstimateError.
[[nodiscard]] ProjectorCalibration calibrateProjector(const SeenProjector& seen,
                                                      const std::vector<SurfaceFit>& surfaces);

/// Refuses a picture that only a bent screen explains, where a plane was declared. Throws ProcedureError.
void checkFlatness(const Surface& surface, const CameraIntrinsics& camera, const SurfaceFit& plane,
                   const SeenProjector& seen, const ProjectorCalibration& fitted);

}  // namespace pixelflex::calib
