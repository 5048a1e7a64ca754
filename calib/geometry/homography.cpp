#include "calib/geometry/homography.h"

#include <cstddef>

namespace pixelflex::calib {

Homography Homography::translation(glm::dvec2 offset) {
  return Homography({1, 0, offset.x, 0, 1, offset.y, 0, 0, 1});
}

Homography Homography::scaling(glm::dvec2 factor) {
  return Homography({factor.x, 0, 0, 0, factor.y, 0, 0, 0, 1});
}

glm::dvec2 Homography::map(glm::dvec2 point) const {
  const double w = weight(point);
  return {(h_[0] * point.x + h_[1] * point.y + h_[2]) / w, (h_[3] * point.x + h_[4] * point.y + h_[5]) / w};
}

double Homography::weight(glm::dvec2 point) const {
  return h_[6] * point.x + h_[7] * point.y + h_[8];
}

Homography Homography::inverse() const {
  const auto& h = h_;
  // The adjugate: an inverse up to scale, which is all that a projective map needs.
  return Homography({h[4] * h[8] - h[5] * h[7], h[2] * h[7] - h[1] * h[8], h[1] * h[5] - h[2] * h[4],
                     h[5] * h[6] - h[3] * h[8], h[0] * h[8] - h[2] * h[6], h[2] * h[3] - h[0] * h[5],
                     h[3] * h[7] - h[4] * h[6], h[1] * h[6] - h[0] * h[7], h[0] * h[4] - h[1] * h[3]});
}

Homography operator*(const Homography& a, const Homography& b) {
  std::array<double, 9> product{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      for (std::size_t k = 0; k < 3; ++k) product[3 * row + column] += a.h_[3 * row + k] * b.h_[3 * k + column];
    }
  }
  return Homography(product);
}

}  // namespace pixelflex::calib
