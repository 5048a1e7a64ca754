#pragma once

#include <span>

#include "calib/estimate/intrinsics.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

struct ProjectorFit {
  ProjectorModel model;
  FitQuality quality;  // found: the samples used; shown is left to the caller
};

/// Homography + Brown lens (k1 k2 k3 p1 p2, centre free) through the samples, least squares in projector pixels with a
/// Huber loss of 0.3 px (calibration reference 1.6, 2). Throws EstimateError for fewer than 12 samples or a degenerate
/// layout.
[[nodiscard]] ProjectorFit fitProjector(std::span<const Sample> samples, devices::Size resolution);

}  // namespace pixelflex::calib
