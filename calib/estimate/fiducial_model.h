#pragma once

#include <array>
#include <glm/vec2.hpp>

#include "calib/estimate/fiducial_fit.h"

namespace pixelflex::calib {

/// White of a marker with its white surround, smoothed: products of error functions along its axes.
class SmoothMarker {
 public:
  explicit SmoothMarker(const MarkerModules& modules);

  struct Value {
    double white;     // 0..1
    double byX, byY;  // its derivatives
  };
  /// `p`: (0, 0) to (1, 1) is the black square; `sigma` of the blur likewise, along each axis.
  [[nodiscard]] Value at(glm::dvec2 p, glm::dvec2 sigma) const;

 private:
  static constexpr std::size_t kColumns = 8;  // of modules: four, the black border and the white one
  /// How much of each column is seen at a place, and how that changes.
  struct Weights {
    std::array<double, kColumns> share{};
    std::array<double, kColumns> slope{};
  };
  static Weights weightsAt(double at, double sigma);

  std::array<std::array<double, kColumns>, kColumns> white_{};
};

}  // namespace pixelflex::calib
