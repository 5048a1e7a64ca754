#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <span>

#include "calib/estimate/intrinsics.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// The light of a projector's white where a camera pixel sees it.
struct SeenLight {
  std::size_t projector = 0;
  glm::dvec2 inCamera{0, 0};   // raw pixels
  glm::dvec2 offMiddle{0, 0};  // of the frame, over half its diagonal: 1 in the corners
  double light = 0;            // linear, any unit
  double density = 0;          // projector pixels per wall unit there: light falls with its square
};

/// How much of the light a camera passes, relative to its principal point.
struct CameraVignetting {
  glm::dvec2 centre{0, 0};        // raw pixels
  double halfDiagonal = 1;        // camera pixels
  std::array<double, 2> terms{};  // k, q: (1 - k r^2) exp(q r^4) for the radius r over halfDiagonal
  [[nodiscard]] double transmission(glm::dvec2 inCamera) const;
};

/// Tells the camera's vignetting from the projectors' by photographs of white alone: both are radial, but the camera's
/// is the same for all projectors, about one centre, and what several projectors light is seen through one and the same
/// part of the lens. A least squares of logarithms, held near what lenses usually do where few projectors leave it
/// open; outliers are set aside. Throws EstimateError for fewer than 100 samples with light.
[[nodiscard]] CameraVignetting estimateVignetting(std::span<const SeenLight> samples, std::size_t projectors,
                                                  const CameraIntrinsics& camera);

}  // namespace pixelflex::calib
