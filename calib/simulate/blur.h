#pragma once

#include <vector>

#include "devices/image/image.h"

namespace pixelflex::calib {

/// One half of a symmetric kernel, [0] the middle, that sums to 1 and whose variance on the pixel lattice is exactly
/// `variance` (pixels squared): sampled Gaussians are narrower than their sigma says when it is small.
[[nodiscard]] std::vector<float> gaussianKernel(double variance);

/// Convolves rows and columns; beyond the border the outermost pixels repeat. Uses both cores.
void blur(devices::ImageF& image, const std::vector<float>& kernel);

}  // namespace pixelflex::calib
