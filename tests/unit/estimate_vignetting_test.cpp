#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "calib/estimate/vignetting.h"

namespace pixelflex::calib {
namespace {

constexpr CameraIntrinsics kCamera{.size = {1920, 1080}, .fx = 1600, .fy = 1600, .cx = 968, .cy = 531};

/// Lenses lose light by 1 - v r^2, which is not the estimator's own formula.
double lost(double share, double square) {
  return 1 - share * square;
}

/// Eight overlapping projectors, four by two, that differ in brightness, vignetting and keystone.
std::vector<SeenLight> wall(double cameraLoss, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> level(0.85, 1.15);
  std::uniform_real_distribution<double> loss(0.2, 0.4);
  std::uniform_real_distribution<double> keystone(-0.1, 0.1);
  std::normal_distribution<double> noise(0, 0.01);
  std::vector<SeenLight> samples;
  for (std::size_t p = 0; p < 8; ++p) {
    const double brightness = level(random);
    const double own = loss(random);
    const double slant = keystone(random);
    for (int k = 0; k < 24 * 18; ++k) {
      const glm::dvec2 f((k % 24 + 0.5) / 24, (static_cast<int>(k / 24) + 0.5) / 18);
      const glm::dvec2 raw(60 + 450.0 * double(p % 4) + 520 * f.x, 60 + 440.0 * double(p / 4) + 500 * f.y);
      const glm::dvec2 offMiddle = (2.0 * f - 1.0) * glm::dvec2(0.8, 0.6);
      const double fall = offMiddle.x * offMiddle.x + offMiddle.y * offMiddle.y;
      const double r2 = (std::pow(raw.x - 960, 2) + std::pow(raw.y - 540, 2)) / (960.0 * 960 + 540.0 * 540);
      const double density = 0.8 * (1 + slant * (f.x - 0.5));
      const double light = brightness * lost(own, fall) * density * density * lost(cameraLoss, r2);
      samples.push_back({p, raw, offMiddle, light * (1 + noise(random)), density});
    }
  }
  return samples;
}

double worst(const CameraVignetting& vignetting, double cameraLoss) {
  // Relative to the middle, where it counts as one.
  double largest = 0;
  for (double t = 0; t <= 0.95; t += 0.05) {
    const glm::dvec2 raw(960 + 960 * t, 540 + 540 * t);
    largest = std::max(largest, std::abs(vignetting.transmission(raw) / lost(cameraLoss, t * t) - 1));
  }
  return largest;
}

TEST(Vignetting, IsToldFromTheProjectors) {
  for (const double loss : {0.0, 0.2, 0.4}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      EXPECT_LT(worst(estimateVignetting(wall(loss, seed), 8, kCamera), loss), 0.02) << loss << " " << seed;
    }
  }
}

TEST(Vignetting, SetsOutliersAside) {
  auto samples = wall(0.3, 1);
  for (std::size_t i = 0; i < samples.size(); i += 17) samples[i].light *= 0.3;  // something stands before the wall
  EXPECT_LT(worst(estimateVignetting(samples, 8, kCamera), 0.3), 0.02);
}

TEST(Vignetting, RefusesDarkness) {
  auto samples = wall(0.3, 1);
  for (auto& sample : samples) sample.light = 0;
  EXPECT_THROW((void)estimateVignetting(samples, 8, kCamera), EstimateError);
}

}  // namespace
}  // namespace pixelflex::calib
