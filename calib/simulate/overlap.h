#pragma once

#include "calib/simulate/projector_light.h"

namespace pixelflex::calib {

/// How much of one frame another one covers along their common seam, as parts of the frames' width or height.
struct Overlap {
  double least = 1;
  double most = 0;
};

/// `second` is to the right of `first`: measured at points of each frame's edge in the pixels of the other frame.
[[nodiscard]] Overlap overlapSideBySide(const ProjectorLight& first, const ProjectorLight& second);
/// `second` is below `first`.
[[nodiscard]] Overlap overlapOneAboveOther(const ProjectorLight& first, const ProjectorLight& second);

}  // namespace pixelflex::calib
