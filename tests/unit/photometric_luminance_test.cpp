#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calib/photometric/light_error.h"
#include "calib/photometric/luminance_target.h"
#include "calib/photometric/smooth_bound.h"
#include "tests/unit/photometric_wall.h"

namespace pixelflex::calib {
namespace {

using devices::ImageF;

ImageF filled(devices::Size size, float value) {
  ImageF image(size, 1);
  std::ranges::fill(image.samples(), value);
  return image;
}

/// The steepest relative change per pixel, by the gradient's length.
double steepest(const ImageF& field) {
  double most = 0;
  for (int y = 0; y + 1 < field.height(); ++y) {
    for (int x = 0; x + 1 < field.width(); ++x) {
      const double here = field.at(x, y);
      if (!(here > 0 && field.at(x + 1, y) > 0 && field.at(x, y + 1) > 0)) continue;
      most = std::max(most, std::hypot(std::log(field.at(x + 1, y) / here), std::log(field.at(x, y + 1) / here)));
    }
  }
  return most;
}

double largestExcess(const ImageF& field, const ImageF& bound) {
  double excess = 0;
  for (std::size_t i = 0; i < field.samples().size(); ++i) {
    if (bound.samples()[i] > 0) excess = std::max(excess, double{field.samples()[i]} / bound.samples()[i] - 1);
  }
  return excess;
}

TEST(SmoothBound, ConstantStaysConstant) {
  const ImageF field = filled({31, 20}, 0.7F);
  const ImageF below = smoothBelow(field, 0.01);
  for (const float value : below.samples()) EXPECT_NEAR(value, 0.7F, 1e-6);
}

TEST(SmoothBound, ADipSpreadsWithTheBound) {
  ImageF field = filled({101, 81}, 1);
  field.at(50, 40) = 0.5F;
  for (const double gradient : {0.005, 0.02, 0.1}) {
    const ImageF below = smoothBelow(field, gradient);
    EXPECT_LT(steepest(below), gradient * 1.002);
    EXPECT_LT(largestExcess(below, field), 1e-6);
    EXPECT_NEAR(below.at(50, 40), 0.5, 0.02);
    // A cone in the logarithm, but for the rounding at its foot and its tip.
    EXPECT_NEAR(std::log(below.at(70, 40) / 0.5), std::min(std::log(2.0), 20 * gradient), 6 * gradient);
  }
  EXPECT_EQ(smoothBelow(field, 0), filled({101, 81}, 0.5F));
}

TEST(SmoothBound, BendsAreRounded) {
  ImageF field = filled({101, 81}, 1);
  field.at(50, 40) = 0.5F;
  const double gradient = 0.02;
  const ImageF below = smoothBelow(field, gradient);
  double sharpest = 0;
  for (int x = 1; x < 100; ++x) {
    sharpest = std::max(sharpest, std::abs(std::log(double{below.at(x - 1, 40)} * below.at(x + 1, 40)) -
                                           2 * std::log(below.at(x, 40))));
  }
  EXPECT_LT(sharpest, 0.5 * gradient);  // a bare cone: twice the gradient
}

TEST(SmoothBound, HolesStayHolesAndDoNotPullDown) {
  ImageF field = filled({60, 40}, 1);
  for (int y = 0; y < 40; ++y) field.at(30, y) = 0;
  field.at(10, 20) = 0.8F;
  const ImageF below = smoothBelow(field, 0.01);
  EXPECT_EQ(below.at(30, 5), 0);
  EXPECT_NEAR(below.at(50, 20), 1, 1e-6);
  EXPECT_NEAR(below.at(12, 20), 0.8, 0.03);
  EXPECT_EQ(smoothBelow(ImageF({9, 9}, 1), 0.1), ImageF({9, 9}, 1));
}

TEST(SmoothBound, AboveIsBelowTurnedRound) {
  ImageF field = filled({60, 40}, 0.01F);
  field.at(10, 20) = 0.04F;
  const ImageF above = smoothAbove(field, 0.05);
  EXPECT_LT(steepest(above), 0.05 * 1.002);
  EXPECT_GE(above.at(10, 20), 0.04F * 0.9999F);
  EXPECT_NEAR(above.at(55, 20), 0.01, 1e-5);
  for (std::size_t i = 0; i < field.samples().size(); ++i) {
    EXPECT_GE(above.samples()[i], field.samples()[i] * 0.99999F);
  }
}

TEST(LuminanceTarget, GradientFallsWithUniformity) {
  double before = 1;
  for (double u = 0; u <= 1; u += 0.05) {
    EXPECT_LE(luminanceGradientPerDegree(u), before);
    before = luminanceGradientPerDegree(u);
  }
  EXPECT_LE(luminanceGradientPerDegree(0.5), 0.01);
  EXPECT_EQ(luminanceGradientPerDegree(1), 0);
}

TEST(LuminanceTarget, IsBoundedEverywhereAndMonotoneInUniformity) {
  const LitWall wall;
  const auto maps = wall.maps();
  constexpr double kPixelsPerDegree = 3.5;
  ImageF before;
  double keptBefore = 1.01;
  for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const auto result = luminanceTarget(maps, u, kPixelsPerDegree);
    EXPECT_LT(largestExcess(result.target, result.available), 1e-6);
    EXPECT_LT(steepest(result.target), luminanceGradientPerDegree(u) / kPixelsPerDegree * 1.002 + 1e-6);
    if (!before.empty()) {
      EXPECT_LT(largestExcess(result.target, before), 1e-6);
    }
    EXPECT_LT(result.kept, keptBefore);
    keptBefore = result.kept;
    before = result.target;
  }
  const auto [least, most] = std::ranges::minmax(before.samples());
  EXPECT_NEAR(least, most, 1e-6);  // uniformity 1
  const auto available = luminanceTarget(maps, 0, kPixelsPerDegree).available;
  EXPECT_NEAR(least, std::ranges::min(available.samples()), 1e-6);
}

TEST(LuminanceTarget, BrightestKeepsNearlyAllTheLight) {
  const auto maps = LitWall().maps();
  EXPECT_GT(luminanceTarget(maps, 0, 3.5).kept, 0.93);
  EXPECT_LT(luminanceTarget(maps, 1, 3.5).kept, 0.80);
}

TEST(LuminanceTarget, OneEvenProjectorIsLeftAlone) {
  const ProjectorLightMaps maps{filled({40, 30}, 2), {}, filled({40, 30}, 1)};
  for (const double u : {0.0, 0.5, 1.0}) EXPECT_NEAR(luminanceTarget({&maps, 1}, u, 5).kept, 1, 2e-3);
}

TEST(LuminanceTarget, DarkWallsAreRefused) {
  const ProjectorLightMaps maps{ImageF({40, 30}, 1), {}, filled({40, 30}, 1)};
  EXPECT_THROW((void)luminanceTarget({&maps, 1}, 0.5, 5), LightError);
}

/// Reads a map as the shader does: stretched over the frame, bilinear, clamped to its border.
double stretched(const devices::Image16& map, glm::dvec2 p, devices::Size frame) {
  const double x = std::clamp(p.x * map.width() / frame.width - 0.5, 0.0, map.width() - 1.0);
  const double y = std::clamp(p.y * map.height() / frame.height - 0.5, 0.0, map.height() - 1.0);
  const int x0 = std::min(static_cast<int>(x), map.width() - 2);
  const int y0 = std::min(static_cast<int>(y), map.height() - 2);
  const auto mixed = [&](int row) { return map.at(x0, row) * (1 - x + x0) + map.at(x0 + 1, row) * (x - x0); };
  return (mixed(y0) * (1 - y + y0) + mixed(y0 + 1) * (y - y0)) / 65535;
}

TEST(GainMap, TheWallGetsItsTarget) {
  const LitWall wall;
  const auto maps = wall.maps();
  for (const double u : {0.0, 0.5, 1.0}) {
    const auto result = luminanceTarget(maps, u, 3.5);
    std::vector<devices::Image16> gains;
    for (std::size_t i = 0; i < maps.size(); ++i) {
      gains.push_back(gainMap(wall.mappings[i], maps[i].white, result.target, wall.raster, {64, 48}));
    }
    double worst = 0;
    double squares = 0;
    int count = 0;
    for (double y = 20.5; y < 508; y += 3.1) {
      for (double x = 20.5; x < 700; x += 3.1) {
        double light = 0;
        for (std::size_t i = 0; i < maps.size(); ++i) {
          const auto p = wall.mappings[i].projectorFromWall({x, y});
          light += wall.shareAt(i, {x, y}) * wall.whiteAt(i, {x, y}) * stretched(gains[i], *p, LitWall::kFrame);
        }
        const double error = light / *valueAt(result.target, wall.raster.rasterFromWall({x, y})) - 1;
        worst = std::max(worst, std::abs(error));
        squares += error * error;
        ++count;
      }
    }
    EXPECT_LT(worst, u < 0.4 ? 0.01 : 0.003) << u;
    EXPECT_LT(std::sqrt(squares / count), 0.001) << u;
  }
}

}  // namespace
}  // namespace pixelflex::calib
