#pragma once

#include <optional>
#include <span>

#include "calib/estimate/intrinsics.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

struct ProjectorFit {
  ProjectorModel model;
  FitQuality quality;  // found: the samples used; shown and cameraScale are left to the caller
};

/// The bent screen that samples lie on.
struct BentScreen {
  double radius = 0;
  double apex = 0;
};

/// Homography (on a bent screen the projection of its cylinder) + Brown lens (k1 k2 k3 p1 p2, centre free) through the
/// samples, least squares in projector pixels with a Huber loss (calibration reference 1.6, 2). A residual spline is
/// added where it lowers the error of samples left out of the fit by a tenth or more. Throws EstimateError for fewer
/// than 12 samples or a degenerate layout.
[[nodiscard]] ProjectorFit fitProjector(std::span<const Sample> samples, devices::Size resolution,
                                        const std::optional<BentScreen>& screen = std::nullopt);

}  // namespace pixelflex::calib
