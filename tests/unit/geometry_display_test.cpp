#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
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

/// The distance of the rectangle's middle from the lattice's, in half cells, squared.
int fromMiddle(const CellRect& rect, const Coverage& coverage) {
  const int dx = rect.left + rect.right - coverage.width();
  const int dy = rect.top + rect.bottom - coverage.height();
  return dx * dx + dy * dy;
}

/// The area of the largest rectangle with sides of this ratio and the least distance of such a one to the lattice's
/// middle (of half cells, squared), every place of every height tried.
std::pair<std::int64_t, int> bruteForceOfRatio(const Coverage& coverage, double ratio) {
  const auto full = [&](const CellRect& rect) {
    for (int y = rect.top; y < rect.bottom; ++y) {
      for (int x = rect.left; x < rect.right; ++x) {
        if (!coverage.covered(x, y)) return false;
      }
    }
    return true;
  };
  std::pair<std::int64_t, int> best{0, 0};
  for (int high = coverage.height(); high > 0 && best.first == 0; --high) {
    const int wide = std::max(1, static_cast<int>(std::lround(high * ratio)));
    for (int y = 0; y + high <= coverage.height(); ++y) {
      for (int x = 0; x + wide <= coverage.width(); ++x) {
        if (!full({x, y, x + wide, y + high})) continue;
        const int off = fromMiddle({x, y, x + wide, y + high}, coverage);
        if (best.first == 0 || off < best.second) best = {std::int64_t{wide} * high, off};
      }
    }
  }
  return best;
}

/// Six loose quadrilaterals on a wall of about 50 units.
std::vector<Outline> randomUnion(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> at(0, 40);
  std::vector<Outline> outlines;
  for (int i = 0; i < 6; ++i) {
    const glm::dvec2 p{at(random), at(random)};
    outlines.push_back({p, p + glm::dvec2(12, at(random) / 10), p + glm::dvec2(14, 11), p + glm::dvec2(-2, 9)});
  }
  return outlines;
}

/// By the number of sides crossed to the left.
bool inside(const Outline& outline, glm::dvec2 p) {
  bool in = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 a = outline[i];
    const glm::dvec2 b = outline[(i + 1) % outline.size()];
    if ((a.y <= p.y) != (b.y <= p.y) && a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) < p.x) in = !in;
  }
  return in;
}

/// A frame whose sides are bent inwards, as a lens with pincushion distortion makes it.
Outline pincushion(glm::dvec2 middle, double turn) {
  Outline outline;
  constexpr std::array<glm::dvec2, 4> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < 64; ++i) {
    const glm::dvec2 p = glm::mix(kCorners[i / 16], kCorners[(i / 16 + 1) % 4], double(i % 16) / 16);
    const glm::dvec2 bent = p * glm::dvec2(32.3, 19.7) * (0.8 + 0.2 * glm::dot(p, p));
    outline.push_back(middle + glm::dvec2(std::cos(turn) * bent.x - std::sin(turn) * bent.y,
                                          std::sin(turn) * bent.x + std::cos(turn) * bent.y));
  }
  return outline;
}

TEST(DisplayArea, CountsExactlyTheCellsWhoseCornersAreLitByOne) {
  const std::vector<Outline> outlines = {pincushion({0.3, 0.1}, 0), pincushion({55, 9}, 0.03), pincushion({20, 30}, 1)};
  const Coverage coverage(outlines, 1);
  std::int64_t count = 0;
  for (int y = 0; y < coverage.height(); ++y) {
    for (int x = 0; x < coverage.width(); ++x) {
      const auto holdsCell = [&](const Outline& outline) {
        return inside(outline, coverage.wallFromCell({x, y})) && inside(outline, coverage.wallFromCell({x + 1, y})) &&
               inside(outline, coverage.wallFromCell({x, y + 1})) &&
               inside(outline, coverage.wallFromCell({x + 1, y + 1}));
      };
      ASSERT_EQ(coverage.covered(x, y), std::ranges::any_of(outlines, holdsCell)) << x << ", " << y;
      count += coverage.covered(x, y) ? 1 : 0;
    }
  }
  EXPECT_GT(count, 4000);
}

TEST(DisplayArea, MatchesBruteForceOfARatioOnRandomUnions) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const Coverage coverage(randomUnion(seed), 1);
    for (const AspectRatio aspect : {AspectRatio{16, 9}, AspectRatio{1, 3}, AspectRatio{7, 1}}) {
      const auto found = largestRectangle(coverage, aspect);
      const auto [area, off] = bruteForceOfRatio(coverage, aspect.width / aspect.height);
      ASSERT_EQ(found ? found->area() : 0, area) << "seed " << seed;
      EXPECT_EQ(found ? fromMiddle(*found, coverage) : 0, off) << "seed " << seed;
    }
  }
}

TEST(DisplayArea, ErosionMatchesBruteForce) {
  for (const int margin : {1, 2, 5, 40}) {
    const Coverage whole(randomUnion(3), 1);
    Coverage eroded = whole;
    eroded.erode(margin);
    const auto keeps = [&](int x, int y) {
      for (int j = y - margin; j <= y + margin; ++j) {
        for (int i = x - margin; i <= x + margin; ++i) {
          const bool on = i >= 0 && j >= 0 && i < whole.width() && j < whole.height();
          if (!on || !whole.covered(i, j)) return false;
        }
      }
      return true;
    };
    for (int y = 0; y < whole.height(); ++y) {
      for (int x = 0; x < whole.width(); ++x) ASSERT_EQ(eroded.covered(x, y), keeps(x, y)) << margin;
    }
  }
}

TEST(DisplayArea, MatchesBruteForceOnRandomUnions) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const Coverage coverage(randomUnion(seed), 1);
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
