#pragma once

#include <glm/vec2.hpp>

#include "calib/geometry/brown_lens.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// Raw camera pixels to the pixels of the same camera with a perfect lens, and back.
class CameraMapping {
 public:
  CameraMapping() = default;  // a perfect lens: both maps are the identity
  explicit CameraMapping(const CameraIntrinsics& intrinsics);

  /// Where a perfect lens would have put what is seen at this pixel. Points that the lens model cannot invert (outside
  /// its disc, never on a calibrated picture) come back unchanged.
  [[nodiscard]] glm::dvec2 undistortedFromRaw(glm::dvec2 pointInRaw) const;
  [[nodiscard]] glm::dvec2 rawFromUndistorted(glm::dvec2 pointInUndistorted) const;

 private:
  BrownLens lens_;
  glm::dvec2 focal_{1, 1};
  glm::dvec2 centre_{0, 0};
};

}  // namespace pixelflex::calib
