#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "calib/capture/photographs.h"
#include "calib/estimate/camera_response.h"
#include "calib/photometric/response_curve.h"
#include "calib/procedure/progress.h"
#include "calib/store/calibration.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// A projector's response as the camera saw it.
struct MeasuredResponse {
  ResponseCurve curve;
  double error = 0;            // expected, relative to light (1 % of white at least), RMS over codes 20 to 235
  std::optional<double> leak;  // black over white above black, where that could be told
};

struct ResponseResult {
  std::optional<CameraResponse> camera;               // where it was measured
  std::map<std::string, MeasuredResponse> responses;  // by projector
};

/// Called when a projector's response cannot be had: throws, or goes on without it.
using ResponseFailure = std::function<void(const std::string& projector, const std::string& problem)>;

/// Measures the responses of the calibrated projectors of this wall that say `gamma: camera`, of all or only some by
/// name. Throws ProcedureError, CaptureError.
[[nodiscard]] ResponseResult measureResponses(const Wall& wall, const Calibration& calibration,
                                              const std::set<std::string>& only, Photographs& source,
                                              Progress& progress, const ResponseFailure& fail);

/// What the camera's codes stand for: as the wall says, else as stored under this name of a file, else proportional to
/// light. Throws StoreError.
[[nodiscard]] CameraResponse cameraResponse(const CameraSource& camera, const std::optional<std::string>& file);

/// Of the responses, RMS.
[[nodiscard]] double typicalError(const std::map<std::string, MeasuredResponse>& responses);

/// A camera's response as a file holds it.
[[nodiscard]] std::string formatCameraResponse(const CameraResponse& camera);

}  // namespace pixelflex::calib
