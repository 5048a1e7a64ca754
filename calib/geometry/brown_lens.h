#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <limits>
#include <optional>

namespace pixelflex::calib {

/// Brown's lens distortion on the normalised plane: three radial and two tangential coefficients (report 5.1.1, in the
/// sense and signs that OpenCV uses).
class BrownLens {
 public:
  BrownLens() = default;  // perfect
  BrownLens(const std::array<double, 3>& radial, const std::array<double, 2>& tangential);

  /// Ideal to distorted. A template so that automatic differentiation can pass through it.
  template <class T>
  static void distort(const T& x, const T& y, const T* radialTerms, const T* tangentialTerms, T* xOut, T* yOut) {
    const T r2 = x * x + y * y;
    const T factor = T(1) + r2 * (radialTerms[0] + r2 * (radialTerms[1] + r2 * radialTerms[2]));
    *xOut = x * factor + T(2) * tangentialTerms[0] * x * y + tangentialTerms[1] * (r2 + T(2) * x * x);
    *yOut = y * factor + tangentialTerms[0] * (r2 + T(2) * y * y) + T(2) * tangentialTerms[1] * x * y;
  }

  [[nodiscard]] glm::dvec2 distort(glm::dvec2 ideal) const;

  /// The ideal point within the lens's invertible disc that distorts to this one, to 1e-13; none when the iteration
  /// leaves the disc (the point is not on the picture).
  [[nodiscard]] std::optional<glm::dvec2> undistort(glm::dvec2 distorted) const;

  /// The radius up to which the radial polynomial still grows; beyond it the picture would fold over. Infinite when it
  /// never folds.
  [[nodiscard]] double foldRadius() const { return foldRadius_; }

 private:
  struct Jacobian {
    double xx, xy, yy;  // symmetric: d(xOut)/dy equals d(yOut)/dx in Brown's model
  };
  [[nodiscard]] Jacobian jacobianAt(glm::dvec2 ideal) const;

  std::array<double, 3> radial_{};
  std::array<double, 2> tangential_{};
  double foldRadius_ = std::numeric_limits<double>::infinity();
};

}  // namespace pixelflex::calib
