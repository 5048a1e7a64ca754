#pragma once

#include <vector>

#include "calib/patterns/blob_light.h"

namespace pixelflex::calib {

// What can be said of a projector's photographs before any blob is told from another.

/// Sizes that differ, one photograph under two names, black exchanged with another.
[[nodiscard]] std::vector<PhotoProblem> checkFiles(const PatternPhotoRefs& photos);

/// Why no frame is seen between black and white.
[[nodiscard]] PhotoProblem explainNoFrame(const PatternPhotoRefs& photos);

/// Over-exposure, room light, frames of other projectors.
[[nodiscard]] std::vector<PhotoProblem> checkLight(const PatternPhotoRefs& photos, const FrameLight& frame);

}  // namespace pixelflex::calib
