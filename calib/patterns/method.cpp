#include "calib/patterns/method.h"

#include "calib/patterns/blob_pattern.h"
#include "calib/patterns/dense_pattern.h"

namespace pixelflex::calib {

std::string methodName(Method method) {
  return method == Method::kBlobs ? "blobs" : "dense";
}

std::vector<ProjectedPattern> patternsOf(Method method, devices::Size resolution, BlobSize size) {
  if (method == Method::kDense) return densePatterns(resolution);
  std::vector<ProjectedPattern> patterns;
  for (const Pattern pattern : allPatterns()) patterns.push_back(projected(pattern, BlobLayout(resolution, size)));
  return patterns;
}

}  // namespace pixelflex::calib
