#pragma once

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <optional>

#include "calib/simulate/rig.h"

namespace pixelflex::calib {

/// The imaging law of one lens: a ray's normalised coordinates (x/z, y/z) are distorted after Brown (1966), then scaled
/// by the focal length and shifted to the principal point.
class Lens {
 public:
  explicit Lens(const Optics& optics);

  /// Pixel of a ray; none beyond the radius where the polynomial folds back and several rays would meet in one pixel.
  [[nodiscard]] std::optional<glm::dvec2> pixelFromRay(glm::dvec2 ray) const;

  /// The ray of a pixel, by Newton's iteration to 1e-13; none where no ray reaches that pixel.
  [[nodiscard]] std::optional<glm::dvec2> rayFromPixel(glm::dvec2 pixel) const;

  /// Where the radial polynomial turns: the largest usable length of a ray's normalised coordinates (at most 4).
  [[nodiscard]] double foldRadius() const { return foldRadius_; }

 private:
  [[nodiscard]] glm::dvec2 distorted(glm::dvec2 ray) const;
  [[nodiscard]] glm::dmat2 slope(glm::dvec2 ray) const;  // columns: derivative by x, by y

  Optics optics_;
  double foldRadius_;
};

}  // namespace pixelflex::calib
