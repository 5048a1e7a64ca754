#pragma once

#include "devices/image/image.h"

namespace pixelflex::calib {

/// A projector's light without the photographs' noise: over every neighbourhood of about an eighth of the frame, the
/// second-order surface that fits best. Whatever stands out from it (a marker on the
/// wall, a speck) is set aside, and small holes are filled. `field`: three channels; nodes that were not seen are 0,
/// and stay 0 where too few around them were seen.
[[nodiscard]] devices::ImageF smoothField(const devices::ImageF& field);

}  // namespace pixelflex::calib
