#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "calib/geometry/display_area.h"

namespace pixelflex::calib {
namespace {

constexpr int kUnions = 200;

/// Casually aimed frames on a wall of about 90 by 60 units, thrown so loosely that many unions have holes or islands.
std::vector<Outline> randomFootprints(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<Outline> outlines;
  const int count = 4 + static_cast<int>(random() % 8);
  for (int i = 0; i < count; ++i) {
    const glm::dvec2 middle{between(0, 80), between(0, 50)};
    const glm::dvec2 half{between(4, 20), between(2, 7)};
    const double turn = between(-0.2, 0.2) + (i % 2 == 0 ? 0 : 1.5708);
    Outline outline;
    for (const glm::dvec2 corner : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)}) {
      const glm::dvec2 p = corner * half * between(0.85, 1.15);
      outline.push_back(middle + glm::dvec2(std::cos(turn) * p.x - std::sin(turn) * p.y,
                                            std::sin(turn) * p.x + std::cos(turn) * p.y));
    }
    outlines.push_back(outline);
  }
  if (random() % 3 == 0) {
    // A ring of four bars.
    const glm::dvec2 p{between(0, 50), between(0, 30)};
    const glm::dvec2 q = p + glm::dvec2(between(18, 30), between(15, 25));
    const double bar = between(3, 6);
    for (const auto& [low, high] :
         {std::pair(p, glm::dvec2(q.x, p.y + bar)), std::pair(glm::dvec2(p.x, q.y - bar), q),
          std::pair(p, glm::dvec2(p.x + bar, q.y)), std::pair(glm::dvec2(q.x - bar, p.y), q)}) {
      outlines.push_back({low, {high.x, low.y}, high, {low.x, high.y}});
    }
  }
  return outlines;
}

/// To the left of every side of a convex outline, or within a hair of it.
bool insideConvex(const Outline& outline, glm::dvec2 p) {
  constexpr double kHair = 1e-5;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 a = outline[i];
    const glm::dvec2 along = glm::normalize(outline[(i + 1) % outline.size()] - a);
    if (along.x * (p - a).y - along.y * (p - a).x < -kHair) return false;
  }
  return true;
}

bool lit(const std::vector<Outline>& outlines, glm::dvec2 p) {
  return std::ranges::any_of(outlines, [&](const Outline& outline) { return insideConvex(outline, p); });
}

/// The lattice by brute force: cells of one unit from the corner of the bounding box.
class Lattice {
 public:
  Lattice(const std::vector<Outline>& outlines, int margin) {
    glm::dvec2 low{1e9, 1e9};
    glm::dvec2 high{-1e9, -1e9};
    for (const auto& outline : outlines) {
      for (const glm::dvec2 p : outline) low = glm::min(low, p), high = glm::max(high, p);
    }
    width_ = static_cast<int>(high.x - low.x);
    height_ = static_cast<int>(high.y - low.y);
    const auto cornersLit = [&](int x, int y) {
      // One frame must hold the whole cell, or a notch between two could hide in it.
      return std::ranges::any_of(outlines, [&](const Outline& outline) {
        return insideConvex(outline, low + glm::dvec2(x, y)) && insideConvex(outline, low + glm::dvec2(x + 1, y)) &&
               insideConvex(outline, low + glm::dvec2(x, y + 1)) &&
               insideConvex(outline, low + glm::dvec2(x + 1, y + 1));
      });
    };
    std::vector<std::vector<bool>> whole;
    for (int y = 0; y < height_; ++y) {
      auto& row = whole.emplace_back();
      for (int x = 0; x < width_; ++x) row.push_back(cornersLit(x, y));
    }
    erode(whole, margin);
  }

  [[nodiscard]] bool free(int x, int y) const { return free_[index(y)][index(x)]; }

  /// Every pair of a top and a bottom, and the longest run of columns that are free between them.
  [[nodiscard]] int largestArea() const {
    int best = 0;
    for (int top = 0; top < height_; ++top) {
      std::vector<bool> columns(index(width_), true);
      for (int bottom = top; bottom < height_; ++bottom) {
        int run = 0;
        for (int x = 0; x < width_; ++x) {
          columns[index(x)] = columns[index(x)] && free(x, bottom);
          run = columns[index(x)] ? run + 1 : 0;
          best = std::max(best, run * (bottom + 1 - top));
        }
      }
    }
    return best;
  }

  /// Every place of every height; the width is the nearest to the ratio.
  [[nodiscard]] int largestArea(double ratio) const {
    int best = 0;
    for (int high = 1; high <= height_; ++high) {
      const int wide = std::max(1, static_cast<int>(std::lround(high * ratio)));
      for (int y = 0; y + high <= height_; ++y) {
        for (int x = 0; x + wide <= width_; ++x) {
          if (allFree(x, y, wide, high)) best = std::max(best, wide * high);
        }
      }
    }
    return best;
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  void erode(const std::vector<std::vector<bool>>& whole, int margin) {
    free_ = whole;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        for (int dy = -margin; dy <= margin; ++dy) {
          for (int dx = -margin; dx <= margin; ++dx) {
            const bool out = x + dx < 0 || y + dy < 0 || x + dx >= width_ || y + dy >= height_;
            if (out || !whole[index(y + dy)][index(x + dx)]) free_[index(y)][index(x)] = false;
          }
        }
      }
    }
  }

  [[nodiscard]] bool allFree(int left, int top, int wide, int high) const {
    for (int y = top; y < top + high; ++y) {
      for (int x = left; x < left + wide; ++x) {
        if (!free(x, y)) return false;
      }
    }
    return true;
  }

  int width_ = 0, height_ = 0;
  std::vector<std::vector<bool>> free_;
};

/// Every point of the rectangle, widened by the margin, is lit, looked at far more finely than the lattice.
void expectLit(const Display& d, int margin, const std::vector<Outline>& outlines) {
  constexpr double kStep = 0.125;
  const int across = static_cast<int>(std::lround((d.right - d.left + 2 * margin) / kStep));
  const int down = static_cast<int>(std::lround((d.bottom - d.top + 2 * margin) / kStep));
  for (int y = 0; y <= down; ++y) {
    for (int x = 0; x <= across; ++x) {
      const glm::dvec2 p = glm::dvec2(d.left - margin, d.top - margin) + kStep * glm::dvec2(x, y);
      ASSERT_TRUE(lit(outlines, p)) << "dark at " << p.x << ", " << p.y;
    }
  }
}

void compare(unsigned seed, std::optional<AspectRatio> aspect, int margin) {
  std::mt19937 random(seed);
  const auto outlines = randomFootprints(random);
  const Lattice lattice(outlines, margin);
  const int optimum = aspect ? lattice.largestArea(aspect->width / aspect->height) : lattice.largestArea();
  const std::vector<double> densities(outlines.size(), 1.0);
  const DisplayRequest request{.aspect = aspect, .margin = margin};
  const DesktopRequest desktop{.density = DensityRule::kFixed, .pixelsPerUnit = 1};
  if (optimum == 0) {
    EXPECT_THROW((void)findDisplay(outlines, densities, request, desktop), GeometryError) << "seed " << seed;
    return;
  }
  const Display display = findDisplay(outlines, densities, request, desktop);
  EXPECT_GE(static_cast<double>(display.resolution.area()), 0.995 * optimum) << "seed " << seed;
  EXPECT_LE(display.resolution.area(), optimum) << "seed " << seed;
  SCOPED_TRACE(seed);
  expectLit(display, margin, outlines);
}

TEST(DisplayOptimum, TheUnionsHaveHolesAndIslands) {
  int withHoles = 0;
  int withIslands = 0;
  for (unsigned seed = 1; seed <= kUnions; ++seed) {
    std::mt19937 random(seed);
    const LitArea area = uniteFootprints(randomFootprints(random));
    withHoles += area.holes.empty() ? 0 : 1;
    withIslands += area.islands.size() > 1 ? 1 : 0;
  }
  EXPECT_GE(withHoles, 30);
  EXPECT_GE(withIslands, 60);
}

TEST(DisplayOptimum, OfAnyAspect) {
  for (unsigned seed = 1; seed <= kUnions; ++seed) compare(seed, std::nullopt, 0);
}

TEST(DisplayOptimum, OfSixteenToNine) {
  for (unsigned seed = 1; seed <= kUnions; ++seed) compare(seed, AspectRatio{16, 9}, 0);
}

TEST(DisplayOptimum, WithAMargin) {
  for (unsigned seed = 1; seed <= kUnions; ++seed) {
    compare(seed, std::nullopt, 2);
    compare(seed, AspectRatio{16, 9}, 2);
  }
}

}  // namespace
}  // namespace pixelflex::calib
