#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <vector>

#include "viewer/tiles/tile_layout.h"

namespace pixelflex::viewer {
namespace {

// The tiles' textures, one byte a texel: how often cut() wrote it, and from where.
class Textures {
 public:
  explicit Textures(const TileLayout& layout) : layout_(layout) {
    written_.resize(static_cast<std::size_t>(layout.count()) * kTileExtent * kTileExtent);
  }

  void write(const TilePart& part) {
    ASSERT_TRUE(boxOf(layout_.desktop()).contains(part.inDesktop));
    for (int y = 0; y < part.inDesktop.height(); ++y) {
      for (int x = 0; x < part.inDesktop.width(); ++x) at(part.layer, part.texel.x + x, part.texel.y + y) += 1;
    }
  }

  // The definition: texel (a, b) of tile (i, j) holds desktop pixel (i*stride - apron + a, j*stride - apron + b).
  void expectWrittenFor(const Box& damaged) {
    for (int layer = 0; layer < layout_.count(); ++layer) {
      for (int b = 0; b < kTileExtent; ++b) {
        for (int a = 0; a < kTileExtent; ++a) {
          const int x = layer % layout_.columns() * kTileStride - kTileApron + a;
          const int y = layer / layout_.columns() * kTileStride - kTileApron + b;
          const Box box = intersect(damaged, boxOf(layout_.desktop()));
          const int expected = x >= box.left && x < box.right && y >= box.top && y < box.bottom ? 1 : 0;
          ASSERT_EQ(at(layer, a, b), expected) << "layer " << layer << " texel " << a << ", " << b;
        }
      }
    }
  }

 private:
  std::uint8_t& at(int layer, int a, int b) {
    const auto row = static_cast<std::size_t>(layer) * kTileExtent + static_cast<std::size_t>(b);
    return written_.at(row * kTileExtent + static_cast<std::size_t>(a));
  }

  const TileLayout& layout_;
  std::vector<std::uint8_t> written_;
};

void expectExactCut(devices::Size desktop, const Box& damaged) {
  SCOPED_TRACE(::testing::Message() << desktop.width << "x" << desktop.height << ", box " << damaged.left << " "
                                    << damaged.top << " " << damaged.right << " " << damaged.bottom);
  const TileLayout layout(desktop);
  Textures textures(layout);
  for (const TilePart& part : layout.cut(damaged)) textures.write(part);
  if (!::testing::Test::HasFatalFailure()) textures.expectWrittenFor(damaged);
}

TEST(TileLayout, CutsAWholeDesktopOnce) {
  for (const devices::Size desktop : {devices::Size{1, 1}, {1020, 1020}, {1021, 1022}, {1024, 768}, {3840, 2160}}) {
    expectExactCut(desktop, boxOf(desktop));
  }
}

TEST(TileLayout, CutsBoxesAtTileBorders) {
  const devices::Size desktop{2100, 1100};
  for (const int x : {1017, 1018, 1019, 1020, 1021, 1022, 1023}) expectExactCut(desktop, {x, x, x + 1, x + 1});
}

TEST(TileLayout, CutsRandomBoxes) {
  std::mt19937 random(7);
  const devices::Size desktop{2300, 2050};
  for (int i = 0; i < 12; ++i) {
    std::uniform_int_distribution<int> x(-50, desktop.width + 50);
    std::uniform_int_distribution<int> y(-50, desktop.height + 50);
    const auto [left, right] = std::minmax({x(random), x(random)});
    const auto [top, bottom] = std::minmax({y(random), y(random)});
    expectExactCut(desktop, {left, top, right, bottom});
  }
}

TEST(TileLayout, NamesEachTileOnce) {
  const TileLayout layout({3840, 2160});
  std::vector<int> seen(static_cast<std::size_t>(layout.count()));
  for (const TilePart& part : layout.cut(boxOf(layout.desktop()))) seen.at(static_cast<std::size_t>(part.layer)) += 1;
  EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
}

TEST(TileLayout, AnswersForEveryPixelOnceAtTheLargestSize) {
  const TileLayout layout({16384, 16384});
  EXPECT_EQ(layout.columns(), 17);
  EXPECT_EQ(layout.rows(), 17);
  std::int64_t answered = 0;
  std::int64_t cut = 0;
  std::int64_t covered = 0;
  for (int layer = 0; layer < layout.count(); ++layer) {
    EXPECT_TRUE(layout.coverage(layer).contains(layout.patch(layer)));
    answered += layout.patch(layer).area();
    covered += layout.coverage(layer).area();
  }
  for (const TilePart& part : layout.cut(boxOf(layout.desktop()))) cut += part.inDesktop.area();
  EXPECT_EQ(answered, std::int64_t{16384} * 16384);
  EXPECT_EQ(cut, covered);
}

TEST(TileLayout, CoversThePatchAndItsNeighboursTexels) {
  const TileLayout layout({3000, 3000});
  const int middle = layout.columns() + 1;
  EXPECT_EQ(layout.patch(middle), (Box{1020, 1020, 2040, 2040}));
  EXPECT_EQ(layout.coverage(middle), (Box{1018, 1018, 2042, 2042}));
  EXPECT_EQ(layout.origin(middle), glm::ivec2(1018, 1018));
  EXPECT_EQ(layout.coverage(0), (Box{0, 0, 1022, 1022}));
}

TEST(TileLayout, CutsNothingOutsideTheDesktop) {
  const TileLayout layout({1500, 1500});
  EXPECT_TRUE(layout.cut({}).empty());
  EXPECT_TRUE(layout.cut({1500, 0, 1600, 100}).empty());
  EXPECT_TRUE(layout.cut({-100, -100, 0, 1500}).empty());
}

TEST(TileLayout, RefusesADesktopWithoutPixels) {
  EXPECT_THROW(TileLayout({0, 10}), std::invalid_argument);
  EXPECT_THROW(TileLayout({10, -1}), std::invalid_argument);
}

}  // namespace
}  // namespace pixelflex::viewer
