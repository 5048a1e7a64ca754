#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "viewer/tiles/region.h"

namespace pixelflex::viewer {
namespace {

constexpr int kSide = 64;

// The model: one flag a pixel.
class Bitmap {
 public:
  void add(const Box& box) {
    for (int y = box.top; y < box.bottom; ++y) {
      for (int x = box.left; x < box.right; ++x) count_.at(index(x, y)) += 1;
    }
  }
  [[nodiscard]] int at(int x, int y) const { return count_.at(index(x, y)); }

 private:
  static std::size_t index(int x, int y) { return static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x); }
  std::vector<int> count_ = std::vector<int>(std::size_t{kSide} * kSide);
};

Box randomBox(std::mt19937& random, int largest) {
  const auto pick = [&random](int most) { return std::uniform_int_distribution<int>(0, most)(random); };
  const int width = pick(largest);
  const int height = pick(largest);
  const int left = pick(kSide - width);
  const int top = pick(kSide - height);
  return {left, top, left + width, top + height};
}

// What is wrong with pixel (x, y), if anything. `exact`: no pixel more than was added.
std::string problemAt(int covered, int added, bool exact) {
  if (covered > 1) return "boxes overlap";
  if (covered == 0 && added > 0) return "lost";
  return exact && covered > 0 && added == 0 ? "never added" : "";
}

void expectCovers(const Region& region, const Bitmap& added, bool exact) {
  Bitmap covered;
  for (const Box& box : region.boxes()) covered.add(box);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const std::string problem = problemAt(covered.at(x, y), added.at(x, y), exact);
      ASSERT_TRUE(problem.empty()) << problem << " at " << x << ", " << y;
    }
  }
}

TEST(Region, IsExactForAFewBoxes) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    Region region;
    Bitmap model;
    for (int i = 0; i < 5; ++i) {
      const Box box = randomBox(random, 40);
      region.add(box);
      model.add(box);
      expectCovers(region, model, true);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(Region, CoversEverythingWithBoundedBoxesHoweverMany) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    Region region;
    Bitmap model;
    for (int i = 0; i < 400; ++i) {
      const Box box = randomBox(random, seed % 2 == 0 ? 3 : 20);
      region.add(box);
      model.add(box);
      ASSERT_LE(region.boxes().size(), Region::kMaxBoxes);
      if (i % 20 == 0) expectCovers(region, model, false);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(Region, GrowsStripsTogether) {
  Region region;
  for (int y = 0; y < 16384; y += 16) {
    for (int x = 0; x < 16384; x += 2048) region.add({x, y, x + 2048, y + 16});
  }
  ASSERT_EQ(region.boxes().size(), 1u);
  EXPECT_EQ(region.boxes()[0], (Box{0, 0, 16384, 16384}));
  EXPECT_EQ(region.area(), std::int64_t{16384} * 16384);
}

TEST(Region, KeepsFarCornersApart) {
  Region region;
  region.add({0, 0, 64, 64});
  region.add({16000, 8000, 16064, 8064});
  EXPECT_EQ(region.area(), 2 * 64 * 64);
}

TEST(Region, MergesThePairThatWastesTheFewestPixels) {
  Region region;
  for (int i = 0; i < static_cast<int>(Region::kMaxBoxes) - 1; ++i) region.add({i * 100, 0, i * 100 + 1, 1});
  region.add({10000, 500, 10001, 501});
  region.add({10002, 500, 10003, 501});  // one too many, and one pixel from its neighbour
  EXPECT_EQ(region.boxes().size(), Region::kMaxBoxes);
  EXPECT_EQ(region.area(), static_cast<std::int64_t>(Region::kMaxBoxes) - 1 + 3);
}

TEST(Region, IgnoresEmptyBoxesAndClears) {
  Region region;
  region.add({5, 5, 5, 9});
  region.add({5, 5, 4, 9});
  EXPECT_TRUE(region.empty());
  region.add({1, 1, 2, 2});
  region.clear();
  EXPECT_TRUE(region.empty());
  EXPECT_EQ(region.area(), 0);
}

}  // namespace
}  // namespace pixelflex::viewer
