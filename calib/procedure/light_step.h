#pragma once

#include <map>
#include <string>
#include <vector>

#include "calib/capture/photographs.h"
#include "calib/estimate/camera_response.h"
#include "calib/patterns/method.h"
#include "calib/procedure/progress.h"
#include "calib/store/calibration.h"
#include "calib/store/wall.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// What matching the projectors' light gave and cost.
struct LightResult {
  std::map<std::string, LightMatch> matches;       // by projector
  std::map<std::string, MeasuredLight> measured;   // by projector: what they were matched by
  std::map<std::string, devices::Image16> images;  // gain, black and white maps, by path relative to the wall's folder
  double kept = 1;                                 // of the light that the projectors would give unmatched
  double contrastNative = 0;                       // 0 where black was not evened
  double contrastEven = 0;
};

/// Makes the projectors' white alike in brightness and colour, from the photographs of black and white of each, and
/// black even if that is asked for. `masks`: the alpha mask of each calibrated projector, in their order. `leak`: the
/// part of white that each leaks, from its readings; negative where there are none. `camera`: what its codes stand for.
/// Throws ProcedureError, CaptureError.
[[nodiscard]] LightResult matchLight(const Wall& wall, const Calibration& calibration, Method method,
                                     const std::vector<devices::Image16>& masks, const std::vector<double>& leak,
                                     const CameraResponse& camera, Photographs& source, Progress& progress);

}  // namespace pixelflex::calib
