#pragma once

#include <optional>
#include <vector>

#include "calib/capture/photographs.h"
#include "calib/estimate/camera_response.h"
#include "calib/estimate/light_field.h"
#include "calib/patterns/method.h"
#include "calib/photometric/gamut.h"
#include "calib/procedure/progress.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// A projector's light in photographs of full fields.
struct PhotographedLight {
  LightField white;
  /// Columns: what full red, green and blue add to white, in the camera's channels, each row's sum the mean of white;
  /// none where those fields were not photographed.
  std::optional<Matrix3> primaries;
};

/// The light of every calibrated projector, in their order, each photographed from the place of the camera that shows
/// most of it. `camera`: what its codes stand for. `nodesAcross`: of the fields' lattices, along the frame's width. The
/// camera goes round at most twice. Throws ProcedureError, CaptureError.
[[nodiscard]] std::vector<PhotographedLight> photographLight(const Calibration& calibration,
                                                             const CameraResponse& camera, Method method,
                                                             int nodesAcross, Photographs& source, Progress& progress);

/// White as a camera without vignetting would have seen it, three channels. Throws EstimateError.
[[nodiscard]] std::vector<devices::ImageF> withoutVignetting(const Calibration& calibration,
                                                             const std::vector<PhotographedLight>& photographed);

}  // namespace pixelflex::calib
