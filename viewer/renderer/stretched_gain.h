#pragma once

#include "devices/image/image.h"

namespace pixelflex::viewer {

/// The gain picture of one channel stretched over a frame, linear between the centres of its pixels and constant beyond
/// the outermost ones, times the mask (of the frame's size, or empty: 1). 65535 = 1 in both.
[[nodiscard]] devices::ImageF stretchedGain(const devices::Image16& gain, const devices::Image16& mask,
                                            devices::Size frame);

}  // namespace pixelflex::viewer
