#pragma once

#include "calib/geometry/homography.h"
#include "calib/store/nudge.h"
#include "devices/image/size.h"

namespace pixelflex::calib {

/// Where a nudge takes a point of the frame. Throws GeometryError when the corners no longer form a convex frame.
[[nodiscard]] Homography nudgedFromMeasured(const Nudge& nudge, devices::Size resolution);

}  // namespace pixelflex::calib
