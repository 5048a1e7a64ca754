#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "calib/estimate/smooth_field.h"

namespace pixelflex::calib {
namespace {

constexpr devices::Size kNodes{96, 72};

/// A dim projector, brighter to one side and darker in its corners.
double lightAt(int x, int y, int channel) {
  const double u = (x + 0.5) / kNodes.width - 0.5;
  const double v = (y + 0.5) / kNodes.height - 0.5;
  return (20 + 3 * channel) * (1 + 0.2 * u) * (1 - 0.6 * (u * u + v * v));
}

class SmoothField : public ::testing::Test {
 protected:
  devices::ImageF field_{kNodes, 3};
  void SetUp() override {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 0.008);
    fill([&](int x, int y, int c) { return lightAt(x, y, c) * (1 + noise(random)); });
  }
  template <class Light>
  void fill(const Light& light) {
    for (int y = 0; y < kNodes.height; ++y) {
      for (int x = 0; x < kNodes.width; ++x) {
        for (int c = 0; c < 3; ++c) field_.at(x, y, c) = static_cast<float>(light(x, y, c));
      }
    }
  }
  void darken(int left, int top, int extent, float factor) {
    for (int y = top; y < top + extent; ++y) {
      for (int x = left; x < left + extent; ++x) {
        for (int c = 0; c < 3; ++c) field_.at(x, y, c) *= factor;
      }
    }
  }
  static double largestError(const devices::ImageF& smooth) {
    double largest = 0;
    for (int y = 0; y < kNodes.height; ++y) {
      for (int x = 0; x < kNodes.width; ++x) {
        for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(smooth.at(x, y, c) / lightAt(x, y, c) - 1));
      }
    }
    return largest;
  }
};

TEST_F(SmoothField, TakesTheNoiseAway) {
  EXPECT_LT(largestError(smoothField(field_)), 0.008);
}

TEST_F(SmoothField, DoesNotSeeAMarkerOnTheWall) {
  darken(40, 30, 4, 0.3F);
  EXPECT_LT(largestError(smoothField(field_)), 0.008);
}

TEST_F(SmoothField, FillsASmallHole) {
  darken(40, 30, 4, 0);
  EXPECT_LT(largestError(smoothField(field_)), 0.008);
}

TEST_F(SmoothField, LeavesWhatWasNotSeenDark) {
  darken(0, 0, 40, 0);
  const auto smooth = smoothField(field_);
  EXPECT_EQ(smooth.at(5, 5, 1), 0);
  EXPECT_GT(smooth.at(60, 60, 1), 0);
}

}  // namespace
}  // namespace pixelflex::calib
