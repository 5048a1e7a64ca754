#include <gmock/gmock.h>

#include <random>

#include "calib/geometry/display_area.h"

namespace pixelflex::calib {
namespace {

Outline rectangle(double left, double top, double right, double bottom) {
  return {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
}

/// Every rectangle tried, for small lattices.
std::int64_t bruteForceArea(const Coverage& coverage) {
  std::int64_t best = 0;
  for (int top = 0; top < coverage.height(); ++top) {
    for (int left = 0; left < coverage.width(); ++left) {
      int right = coverage.width();
      for (int bottom = top; bottom < coverage.height(); ++bottom) {
        int x = left;
        while (x < right && coverage.covered(x, bottom)) ++x;
        right = x;
        best = std::max(best, std::int64_t{right - left} * (bottom + 1 - top));
      }
    }
  }
  return best;
}

TEST(DisplayArea, MatchesBruteForceOnRandomUnions) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> at(0, 40);
    std::vector<Outline> outlines;
    for (int i = 0; i < 6; ++i) {
      const glm::dvec2 p{at(random), at(random)};
      outlines.push_back({p, p + glm::dvec2(12, at(random) / 10), p + glm::dvec2(14, 11), p + glm::dvec2(-2, 9)});
    }
    const Coverage coverage(outlines, 1);
    const auto found = largestRectangle(coverage);
    EXPECT_EQ(found ? found->area() : 0, bruteForceArea(coverage)) << "seed " << seed;
    if (!found) continue;
    for (int y = found->top; y < found->bottom; ++y) {
      for (int x = found->left; x < found->right; ++x) ASSERT_TRUE(coverage.covered(x, y)) << "seed " << seed;
    }
  }
}

TEST(DisplayArea, FindsTheArmOfAnLAndAvoidsHoles) {
  // An L: a tall and a wide arm; growing from its centroid finds nothing.
  const std::vector<Outline> letterL = {rectangle(0, 0, 10, 60), rectangle(0, 50, 90, 60)};
  const auto found = largestRectangle(Coverage(letterL, 1));
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, (CellRect{0, 50, 90, 60}));
  const std::vector<Outline> ring = {rectangle(0, 0, 100, 20), rectangle(0, 80, 100, 100), rectangle(0, 0, 20, 100),
                                     rectangle(85, 0, 100, 100)};
  EXPECT_EQ(largestRectangle(Coverage(ring, 1))->area(), 2000);
}

TEST(DisplayArea, KeepsTheMarginFromEveryBorder) {
  Coverage coverage(std::vector<Outline>{rectangle(0, 0, 100, 60)}, 1);
  coverage.erode(7);
  EXPECT_EQ(*largestRectangle(coverage), (CellRect{7, 7, 93, 53}));
}

TEST(DisplayArea, ErosionWorksRoundHolesToo) {
  const std::vector<Outline> withNotch = {rectangle(0, 0, 100, 40), rectangle(0, 40, 45, 60),
                                          rectangle(55, 40, 100, 60)};
  Coverage coverage(withNotch, 1);
  coverage.erode(3);
  for (int y = 37; y < 60; ++y) {
    for (int x = 42; x < 58; ++x) ASSERT_FALSE(coverage.covered(x, y)) << x << " " << y;
  }
  EXPECT_TRUE(coverage.covered(50, 36));
}

TEST(DisplayArea, HoldsTheAspectAskedFor) {
  const Coverage coverage(std::vector<Outline>{rectangle(0, 0, 400, 100)}, 1);
  const auto found = largestRectangle(coverage, AspectRatio{16, 9});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->bottom - found->top, 100);
  EXPECT_EQ(found->right - found->left, 178);
  EXPECT_NEAR(0.5 * (found->left + found->right), 200, 1);  // the most central of many
}

TEST(DisplayArea, TakesResolutionFromDensityAndOversampling) {
  const std::vector<Outline> outlines = {rectangle(0, 0, 1000, 500), rectangle(900, 0, 1900, 500)};
  const std::vector<double> densities = {1.0, 2.0};
  const Display mean = findDisplay(outlines, densities, {.margin = 0}, {});
  EXPECT_EQ(mean.resolution, (devices::Size{2850, 750}));
  EXPECT_EQ(findDisplay(outlines, densities, {.margin = 0}, {.density = DensityRule::kMax}).resolution,
            (devices::Size{3800, 1000}));
  EXPECT_EQ(findDisplay(outlines, densities, {.margin = 0}, {.oversampling = 1.5}).resolution,
            (devices::Size{1900, 500}));
  const Display kept =
      findDisplay(outlines, densities, {.margin = 30}, {.density = DensityRule::kFixed, .pixelsPerUnit = 1});
  EXPECT_DOUBLE_EQ(kept.left, 30);
  EXPECT_DOUBLE_EQ(kept.bottom, 470);
}

TEST(DisplayArea, NeverAsksForMoreThanAServerCanHold) {
  const Display display =
      findDisplay(std::vector<Outline>{rectangle(0, 0, 20000, 4000)}, std::vector<double>{4.0}, {.margin = 0}, {});
  EXPECT_LE(display.resolution.width, kLargestDesktopExtent);
  EXPECT_GT(display.resolution.width, kLargestDesktopExtent - 3);
}

TEST(DisplayArea, SaysWhenNothingIsLeft) {
  EXPECT_THROW((void)findDisplay({}, {}, {}, {}), GeometryError);
  const std::vector<Outline> small = {rectangle(0, 0, 40, 40)};
  EXPECT_THROW((void)findDisplay(small, std::vector<double>{1.0}, {.margin = 24}, {}), GeometryError);
}

TEST(LitArea, CountsIslandsAndHoles) {
  const std::vector<Outline> ring = {rectangle(0, 0, 100, 20), rectangle(0, 80, 100, 100), rectangle(0, 0, 20, 100),
                                     rectangle(80, 0, 100, 100), rectangle(200, 0, 210, 10)};
  const LitArea lit = uniteFootprints(ring);
  ASSERT_EQ(lit.islands.size(), 2u);
  ASSERT_EQ(lit.holes.size(), 1u);
  EXPECT_NEAR(areaOf(lit.holes[0]), 3600, 1e-9);
  EXPECT_NEAR(lit.area, 10000 - 3600 + 100, 1e-9);
  EXPECT_NEAR(overlapArea(ring[0], ring[2]), 400, 1e-9);
}

}  // namespace
}  // namespace pixelflex::calib
