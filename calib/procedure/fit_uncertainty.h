#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "calib/geometry/projector_mapping.h"

namespace pixelflex::calib {

/// How far a projector's fitted model may be off at a place of the wall, from its samples alone. The parts of the seam
/// error's formula (see seams.h).
class FitUncertainty {
 public:
  explicit FitUncertainty(const ProjectorCalibration& projector);

  /// In wall units and their squares; variances are sums over x and y.
  struct Local {
    glm::dvec2 meanResidual{0, 0};  // model minus measured
    double meanVariance = 0;        // of meanResidual, from the samples' noise
    double modelVariance = 0;       // of the model
  };
  /// None where the projector's model says nothing.
  [[nodiscard]] std::optional<Local> at(glm::dvec2 pointInWall) const;

 private:
  static constexpr std::size_t kTerms = 6;  // of a quadratic in two variables
  using Terms = std::array<double, kTerms>;
  struct Residual {
    glm::dvec2 inProjector{0, 0};
    glm::dvec2 inWall{0, 0};
  };
  [[nodiscard]] Terms terms(glm::dvec2 pointInProjector) const;
  [[nodiscard]] double leverage(glm::dvec2 pointInProjector) const;
  void measureResiduals(const ProjectorCalibration& projector);
  [[nodiscard]] double neighbourVariance() const;
  void learnLeverage();
  void addWindow(glm::dvec2 pointInProjector, Local& local) const;

  ProjectorMapping mapping_;
  std::vector<Residual> residuals_;
  double sampleVariance_ = 0;  // projector pixels squared
  double modelVariance_ = 0;   // likewise, mean over the frame
  double spacing_ = 1;         // projector pixels
  std::array<double, kTerms * kTerms> inverseNormal_{};
  double meanLeverage_ = 0;  // over the frame; 0: too few samples to tell places apart
};

}  // namespace pixelflex::calib
