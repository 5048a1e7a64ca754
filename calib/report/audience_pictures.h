#pragma once

#include <optional>
#include <string>

#include "calib/procedure/summary.h"
#include "calib/report/wall_light.h"

namespace pixelflex::calib {

/// The audience's view of the wall with white, grey, black, a ramp and text on it, not calibrated beside calibrated, as
/// figures of pictures. Both of a pair have the same exposure; black (left out where not every leak is known) is
/// brightened as its caption says.
[[nodiscard]] std::string audiencePictures(const PredictedView& view, const WallLight& light, const Display& display,
                                           const Summary& summary);

}  // namespace pixelflex::calib
