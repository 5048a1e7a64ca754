#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "calib/estimate/camera_response.h"

namespace pixelflex::calib {

/// One even patch of the scene as one photograph holds it.
struct PatchCode {
  double logExposure = 0;
  double code = 0;  // mean over the patch
};

/// The same patch in all photographs that hold it in range: two or more.
using PatchCodes = std::vector<PatchCode>;

/// Even patches of one channel, a limited number of each tone, spread over the picture. `photos` by rising exposure.
[[nodiscard]] std::vector<PatchCodes> collectPatches(std::span<const ExposedPhoto> photos, int channel);

}  // namespace pixelflex::calib
