#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>

#include "calib/estimate/projector_fit.h"
#include "calib/geometry/homography.h"

namespace pixelflex::calib {

/// The parametric part of a projector's fit: view and lens, solved with Ceres. Keeps the samples' span.
class LensSolver {
 public:
  /// Throws EstimateError when the samples lie in one place.
  LensSolver(std::span<const Sample> samples, devices::Size resolution, const std::optional<BentScreen>& screen);

  /// Through the samples for which `fold[i]` is not `leftOut` (all, without folds), starting from the solution before,
  /// the first time from a homography. Throws EstimateError when there is no solution.
  void solve(std::span<const int> fold = {}, int leftOut = -1);

  [[nodiscard]] ProjectorModel model() const;

  /// Standard deviation of the model as solved through all samples, from the covariance of its unknowns: projector
  /// pixels, rms over a lattice of the frame.
  [[nodiscard]] double deviation() const;

  /// Over all samples, projector pixels: outliers do not count.
  [[nodiscard]] double medianError() const;

 private:
  /// Ceres blocks. The view takes screen points of unit spread to pixels about the frame's middle, over the scale.
  struct Unknowns {
    std::array<double, 8> homography{};
    std::array<double, 3> depth{};
    std::array<double, 3> radial{};
    std::array<double, 2> tangential{};
    std::array<double, 2> centre{};  // projector pixels from the frame's middle
  };
  struct System;

  [[nodiscard]] glm::dvec3 normalised(glm::dvec2 pointInWall) const;
  void startFromHomography();
  void minimise(std::span<const int> fold, int leftOut, double huber);
  std::span<const Sample> samples_;
  std::optional<BentScreen> screen_;
  devices::Size resolution_;
  glm::dvec2 middle_;
  double scale_;
  Homography normalise_;
  double spread_ = 1;  // wall units
  Unknowns unknowns_;
  bool started_ = false;
};

}  // namespace pixelflex::calib
