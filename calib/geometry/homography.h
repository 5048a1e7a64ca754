#pragma once

#include <array>
#include <glm/vec2.hpp>

namespace pixelflex::calib {

/// A projective map of the plane, 3x3 row major, defined up to scale: (x', y', 1) ~ H (x, y, 1). Name it
/// `targetFromSource`; then targetFromSource.map(pointInSource) is a point in target.
class Homography {
 public:
  Homography() = default;  // identity
  explicit Homography(const std::array<double, 9>& rowMajor) : h_(rowMajor) {}

  [[nodiscard]] static Homography translation(glm::dvec2 offset);
  [[nodiscard]] static Homography scaling(glm::dvec2 factor);

  [[nodiscard]] glm::dvec2 map(glm::dvec2 point) const;
  /// The third homogeneous coordinate at a point: zero on the horizon, changes sign behind it.
  [[nodiscard]] double weight(glm::dvec2 point) const;
  [[nodiscard]] Homography inverse() const;
  [[nodiscard]] const std::array<double, 9>& rowMajor() const { return h_; }

  /// targetFromMiddle * middleFromSource = targetFromSource.
  friend Homography operator*(const Homography& a, const Homography& b);
  bool operator==(const Homography&) const = default;

 private:
  std::array<double, 9> h_{1, 0, 0, 0, 1, 0, 0, 0, 1};
};

}  // namespace pixelflex::calib
