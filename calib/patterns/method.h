#pragma once

#include <string>
#include <vector>

#include "calib/patterns/blob_pattern.h"
#include "calib/patterns/projected_pattern.h"
#include "devices/image/size.h"

namespace pixelflex::calib {

/// What the projectors show to be measured: the report's blobs, or stripes that measure every camera pixel (for curved
/// screens and coarse cameras).
enum class Method { kBlobs, kDense };

/// "blobs" or "dense".
[[nodiscard]] std::string methodName(Method method);

/// Every picture of a method, in the order that its decoder takes the photographs.
[[nodiscard]] std::vector<ProjectedPattern> patternsOf(Method method, devices::Size resolution,
                                                       BlobSize size = BlobSize::kUsual);

}  // namespace pixelflex::calib
