#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>

#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// A residual spline over a frame, made usable.
class ResidualMap {
 public:
  ResidualMap() = default;  // moves nothing
  ResidualMap(ResidualSpline spline, devices::Size resolution);

  /// The sixteen control points that decide the correction at a point of the frame, and their weights (sum 1).
  struct Support {
    std::array<std::size_t, 16> index{};
    std::array<double, 16> weight{};
  };
  [[nodiscard]] static Support supportOf(const ResidualSpline& spline, devices::Size resolution, glm::dvec2 point);

  /// Pixel of the lens model to projector pixel.
  [[nodiscard]] glm::dvec2 apply(glm::dvec2 point) const;
  /// Back, to 1e-10 px; none when the correction is so steep that it folds the frame.
  [[nodiscard]] std::optional<glm::dvec2> invert(glm::dvec2 pointInProjector) const;

 private:
  [[nodiscard]] glm::dvec2 correction(glm::dvec2 point) const;
  ResidualSpline spline_;
  devices::Size resolution_;
};

}  // namespace pixelflex::calib
