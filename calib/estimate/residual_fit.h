#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>

#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// Samples are left out in turn by folds 0..kFolds-1.
inline constexpr int kFolds = 5;

/// What a lens model leaves at one sample.
struct ResidualSample {
  glm::dvec2 at{0, 0};        // pixel of the lens model
  glm::dvec2 residual{0, 0};  // measured minus model, projector pixels
  int fold = 0;
};

struct ResidualChoice {
  int columns = 0;  // cells of the spline
  int rows = 0;
  double stiffness = 0;  // weight of its second differences
};

/// The size and stiffness of the correction that predicts samples left out best. None when it predicts them less than a
/// tenth better than no correction does.
[[nodiscard]] std::optional<ResidualChoice> chooseResidual(std::span<const ResidualSample> samples,
                                                           devices::Size resolution);

/// The penalised least-squares spline through the samples, those of fold `leftOut` excepted; outliers are set aside.
[[nodiscard]] ResidualSpline fitResidual(std::span<const ResidualSample> samples, const ResidualChoice& choice,
                                         devices::Size resolution, int leftOut = -1);

}  // namespace pixelflex::calib
