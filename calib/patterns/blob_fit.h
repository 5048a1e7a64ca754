#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>

namespace pixelflex::calib {

/// One observation of a blob: a place and the light there, 0..1.
struct LightSample {
  glm::dvec2 at{0, 0};
  double light = 0;
};

struct GaussianFit {
  glm::dvec2 centre{0, 0};
  double sigma = 0;
  double amplitude = 0;
  double background = 0;
  double error = 0;  // standard deviation of the centre, per axis, by the residuals
};

/// Least-squares fit of background + amplitude * exp(-|p - centre|^2 / 2 sigma^2), Levenberg-Marquardt from the start
/// given. None when it does not converge or there are fewer than 12 samples.
[[nodiscard]] std::optional<GaussianFit> fitGaussian(std::span<const LightSample> samples, const GaussianFit& start);

}  // namespace pixelflex::calib
