#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "calib/photometric/black_lift.h"
#include "calib/photometric/lift_colour.h"
#include "calib/photometric/light_error.h"
#include "calib/photometric/luminance_target.h"
#include "tests/unit/photometric_wall.h"

namespace pixelflex::calib {
namespace {

constexpr double kLargest = 0.0625;  // what a lift map holds

class BlackLift : public ::testing::Test {
 protected:
  /// The lift of every projector for an even black with this gradient per raster pixel.
  void lift(double gradient) {
    const auto luminance = luminanceTarget(maps_, 0.5, 3.5);
    black_ = blackTarget(maps_, luminance.target, gradient);
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      devices::Image16 alpha(LitWall::kFrame, 1);
      for (int y = 0; y < alpha.height(); ++y) {
        for (int x = 0; x < alpha.width(); ++x) {
          const auto inWall = *wall_.mappings[i].wallFromProjector({x + 0.5, y + 0.5});
          alpha.at(x, y) = static_cast<std::uint16_t>(std::lround(65535 * wall_.shareAt(i, inWall)));
        }
      }
      lifts_.push_back(blackLiftMap(i, wall_.mappings, maps_, black_, wall_.raster, alpha, kLargest));
    }
  }

  [[nodiscard]] double leakAt(glm::dvec2 pointInWall) const {
    double sum = 0;
    for (std::size_t i = 0; i < maps_.size(); ++i) sum += wall_.blackAt(i, pointInWall);
    return sum;
  }

  /// What the wall shows for black: the leak of all, and each one's lift.
  [[nodiscard]] double blackAt(glm::dvec2 pointInWall) const {
    double sum = leakAt(pointInWall);
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      const auto p = wall_.mappings[i].projectorFromWall(pointInWall);
      if (!p || !wall_.mappings[i].insideFrame(*p)) continue;
      const double part = lifts_[i].at(static_cast<int>(p->x), static_cast<int>(p->y)) / 65535.0;
      sum += part * kLargest * wall_.whiteAt(i, pointInWall);
    }
    return sum;
  }

  /// How many frames hold the point and a pixel around it; none on a border.
  [[nodiscard]] int framesAt(glm::dvec2 pointInWall) const {
    int count = 0;
    for (const auto& mapping : wall_.mappings) {
      const auto p = *mapping.projectorFromWall(pointInWall);
      const double inside = std::min({p.x, LitWall::kFrame.width - p.x, p.y, LitWall::kFrame.height - p.y});
      if (std::abs(inside) < 1.5) return 0;
      if (inside > 0) ++count;
    }
    return count;
  }

  LitWall wall_;
  std::vector<ProjectorLightMaps> maps_ = wall_.maps();
  BlackTarget black_;
  std::vector<devices::Image16> lifts_;
};

TEST_F(BlackLift, TheWallIsEvenWhereOneTwoAndFourOverlap) {
  lift(0);
  std::array<int, 5> seen{};
  double most = 0;
  double least = 1;
  double leakMost = 0;
  double leakLeast = 1;
  for (double y = 18.3; y < 510; y += 3.7) {
    for (double x = 18.3; x < 702; x += 3.7) {
      const int frames = framesAt({x, y});
      if (frames == 0) continue;
      ++seen.at(static_cast<std::size_t>(frames));
      most = std::max(most, blackAt({x, y}));
      least = std::min(least, blackAt({x, y}));
      leakMost = std::max(leakMost, leakAt({x, y}));
      leakLeast = std::min(leakLeast, leakAt({x, y}));
    }
  }
  EXPECT_GT(seen[1], 1000);
  EXPECT_GT(seen[2], 1000);
  EXPECT_GT(seen[4], 200);
  EXPECT_GT(leakMost / leakLeast, 4);
  EXPECT_LT(most / least, 1.03);          // half a pixel's lag of two masks, too
  EXPECT_NEAR(most / leakMost, 1, 0.02);  // nothing is lifted above the worst
}

TEST_F(BlackLift, BordersAreEvenWithinTheirPixels) {
  lift(0);
  double squares = 0;
  int count = 0;
  for (double y = 18.3; y < 510; y += 1.7) {
    for (double x = 18.3; x < 702; x += 1.7) {
      squares += std::pow(blackAt({x, y}) / black_.target.at(0, 0) - 1, 2);
      ++count;
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.03);  // half a pixel's lag along borders
}

TEST_F(BlackLift, ABoundInsteadOfAConstantCostsLessContrast) {
  lift(0);
  const auto even = black_;
  lifts_.clear();
  lift(0.01);
  EXPECT_GT(even.contrastNative, black_.contrastEven);
  EXPECT_GT(black_.contrastEven, even.contrastEven);
  EXPECT_GT(even.contrastNative, 200);
  EXPECT_LT(even.contrastNative, 600);
  double worst = 0;
  for (double y = 30.3; y < 500; y += 5.7) {
    for (double x = 30.3; x < 690; x += 5.7) {
      if (framesAt({x, y}) == 0) continue;
      const double wanted = *valueAt(black_.target, wall_.raster.rasterFromWall({x, y}));
      worst = std::max(worst, std::abs(blackAt({x, y}) / wanted - 1));
    }
  }
  EXPECT_LT(worst, 0.02);
}

TEST_F(BlackLift, LargestLiftIsWhatTheMapsHold) {
  lift(0);
  double most = 0;
  for (const auto& map : lifts_) most = std::max(most, std::ranges::max(map.samples()) / 65535.0 * kLargest);
  EXPECT_GT(most, 0.9 * black_.largestLift);
  EXPECT_LT(black_.largestLift, kLargest);
}

/// The leaks are tinted like the whites; one projector, in the middle of the lit area, leaks most.
TEST_F(BlackLift, LiftsHaveTheColourThatIsMissing) {
  const std::vector<glm::dvec3> tints = {{1.08, 1, 0.92}, {0.95, 1, 1.06}, {1, 0.96, 1}, {0.93, 1, 1.07}};
  std::vector<Matrix3> primaries;
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    primaries.push_back({tints[i].x, 0, 0, 0, tints[i].y, 0, 0.02, 0, tints[i].z});
  }
  const glm::dvec3 weights(kCameraLuminance[0], kCameraLuminance[1], kCameraLuminance[2]);
  const auto made = [&](std::size_t i, glm::dvec3 own) {
    const auto& m = primaries[i];
    return glm::dvec3(m[0] * own.x, m[4] * own.y, m[6] * own.x + m[8] * own.z);
  };
  lift(0);
  const auto colours = liftColours(primaries, maps_, black_);
  // Where four overlap black is native; in the middle of each frame's own part it is leak and lift.
  glm::dvec3 native(0);
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    const glm::dvec3 white = made(i, glm::dvec3(1));
    native += wall_.blackAt(i, {360, 265}) * white / glm::dot(weights, white);
  }
  native /= glm::dot(weights, native);
  const std::vector<glm::dvec2> middles = {{150, 120}, {560, 120}, {150, 410}, {560, 410}};
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    const glm::dvec3 white = made(i, glm::dvec3(1));
    const double luminance = glm::dot(weights, white);
    const glm::dvec3 own(colours[i][0], colours[i][1], colours[i][2]);
    EXPECT_NEAR(glm::dot(weights, made(i, own)) / luminance, 1, 1e-6) << i;
    const double leak = leakAt(middles[i]);
    const glm::dvec3 black = leak * white / luminance + (black_.target.at(0, 0) - leak) * made(i, own) / luminance;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(black[c] / black_.target.at(0, 0), native[c], 0.01) << i << ' ' << c;
  }
}

TEST_F(BlackLift, LiftsOfProjectorsThatAreAlikeAreWhite) {
  lift(0);
  const std::vector<Matrix3> primaries(maps_.size(), Matrix3{1, 0, 0, 0, 1, 0, 0, 0, 1});
  for (const auto& colour : liftColours(primaries, maps_, black_)) {
    for (const double channel : colour) EXPECT_NEAR(channel, 1, 1e-6);
  }
}

TEST_F(BlackLift, NoLeakSeenIsRefused) {
  for (auto& maps : maps_) std::ranges::fill(maps.black.samples(), 0.0F);
  EXPECT_THROW(lift(0), LightError);
}

}  // namespace
}  // namespace pixelflex::calib
