#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include "calib/estimate/camera_response.h"

namespace pixelflex::calib {

/// A camera with a known curve, shot and read noise, made apart from the simulator's.
struct TestCamera {
  std::function<double(double light)> curve;  // 0..1 to 0..1
  double electrons = 12000;                   // at full scale
  double read = 3;

  [[nodiscard]] std::uint8_t code(double light, std::mt19937& random) const {
    std::normal_distribution<double> normal;
    const double clipped = std::clamp(light, 0.0, 1.2);
    const double seen = clipped + std::sqrt(clipped / electrons + std::pow(read / electrons, 2)) * normal(random);
    return static_cast<std::uint8_t>(std::lround(255 * curve(std::clamp(seen, 0.0, 1.0))));
  }

  /// A photograph of light(x, y, channel) times exposure.
  template <class Light>
  [[nodiscard]] ExposedPhoto shoot(devices::Size size, double exposure, const Light& light,
                                   std::mt19937& random) const {
    ExposedPhoto one{exposure, devices::Image8(size, 3)};
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        for (int c = 0; c < 3; ++c) one.photo.at(x, y, c) = code(exposure * light(x, y, c), random);
      }
    }
    return one;
  }
};

inline double srgbFromLight(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

/// sRGB with the S-bend of a picture style: darker darks, softer brights.
inline double bentFromLight(double light) {
  const double v = srgbFromLight(light);
  return v + 0.06 * std::sin(2 * 3.14159265358979 * (v - 0.5)) * (v < 0.5 ? 0.8 : 1.0);
}

/// The light of a code: the middle of what rounds to it.
inline double lightOfCode(const TestCamera& camera, double code) {
  double low = 0;
  double high = 1;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (255 * camera.curve(middle) < code ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace pixelflex::calib
