#pragma once

#include <vector>

#include "calib/capture/photographs.h"
#include "calib/estimate/light_field.h"
#include "calib/patterns/method.h"
#include "calib/procedure/progress.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// The light of every calibrated projector's white, in their order, each photographed from the place of the camera that
/// shows most of it. `nodesAcross`: of the fields' lattices, along the frame's width. The camera goes round at most
/// twice. Throws ProcedureError, CaptureError.
[[nodiscard]] std::vector<LightField> photographWhite(const Calibration& calibration, Method method, int nodesAcross,
                                                      Photographs& source, Progress& progress);

}  // namespace pixelflex::calib
