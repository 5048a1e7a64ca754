#include "devices/camera/raw_picture.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace pixelflex::devices {
namespace {

using Colour = std::array<std::uint8_t, 3>;

Colour colourAt(const Image8& image, int x, int y) {
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

TEST(RawPicture, GreyIsSpreadAndRowsMayHaveGaps) {
  const std::vector<std::uint8_t> bytes = {1, 2, 99, 3, 4};
  const Image8 image = developed({.layout = RawLayout::kGrey8, .size = {2, 2}, .stride = 3, .bytes = bytes});
  EXPECT_EQ(colourAt(image, 1, 0), (Colour{2, 2, 2}));
  EXPECT_EQ(colourAt(image, 1, 1), (Colour{4, 4, 4}));
}

TEST(RawPicture, DeepGreyIsScaledToEightBits) {
  const std::vector<std::uint8_t> bytes = {0xff, 0x0f, 0x00, 0x08};
  const Image8 image = developed({.layout = RawLayout::kGrey16, .size = {2, 1}, .bits = 12, .bytes = bytes});
  EXPECT_EQ(colourAt(image, 0, 0), (Colour{255, 255, 255}));
  EXPECT_EQ(colourAt(image, 1, 0), (Colour{128, 128, 128}));
}

TEST(RawPicture, BlueMayComeFirst) {
  const std::vector<std::uint8_t> bytes = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(colourAt(developed({.layout = RawLayout::kBgr8, .size = {2, 1}, .bytes = bytes}), 1, 0), (Colour{6, 5, 4}));
  EXPECT_EQ(colourAt(developed({.layout = RawLayout::kRgb8, .size = {2, 1}, .bytes = bytes}), 1, 0), (Colour{4, 5, 6}));
}

TEST(RawPicture, VideoColoursAreThoseOfBt601) {
  // Black, white and full red, as the standard lists them.
  const std::vector<std::uint8_t> greys = {16, 128, 235, 128};
  const Image8 image = developed({.layout = RawLayout::kYuyv, .size = {2, 1}, .bytes = greys});
  EXPECT_EQ(colourAt(image, 0, 0), (Colour{0, 0, 0}));
  EXPECT_EQ(colourAt(image, 1, 0), (Colour{255, 255, 255}));
  const std::vector<std::uint8_t> red = {90, 81, 240, 81};
  const Colour seen = colourAt(developed({.layout = RawLayout::kUyvy, .size = {2, 1}, .bytes = red}), 1, 0);
  EXPECT_NEAR(seen[0], 255, 1);
  EXPECT_NEAR(seen[1], 0, 1);
  EXPECT_NEAR(seen[2], 0, 1);
}

TEST(RawPicture, MosaicsOfOneColourBecomeThatColour) {
  const Colour colour = {200, 90, 30};
  struct Mosaic {
    RawLayout layout;
    std::array<std::size_t, 4> channels;  // of the first two pixels of the first two rows
  };
  for (const auto& [layout, channels] :
       {Mosaic{RawLayout::kBayerRg8, {0, 1, 1, 2}}, Mosaic{RawLayout::kBayerGr8, {1, 0, 2, 1}},
        Mosaic{RawLayout::kBayerGb8, {1, 2, 0, 1}}, Mosaic{RawLayout::kBayerBg8, {2, 1, 1, 0}}}) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t y = 0; y < 6; ++y) {
      for (std::size_t x = 0; x < 8; ++x) bytes.push_back(colour.at(channels.at(2 * (y % 2) + x % 2)));
    }
    const Image8 image = developed({.layout = layout, .size = {8, 6}, .bytes = bytes});
    for (int y = 0; y < 6; ++y) {
      for (int x = 0; x < 8; ++x) EXPECT_EQ(colourAt(image, x, y), colour) << x << ' ' << y;
    }
  }
}

TEST(RawPicture, TooFewBytesAreRefused) {
  const std::vector<std::uint8_t> bytes(11);
  EXPECT_THROW((void)developed({.layout = RawLayout::kRgb8, .size = {2, 2}, .bytes = bytes}), std::runtime_error);
}

}  // namespace
}  // namespace pixelflex::devices
