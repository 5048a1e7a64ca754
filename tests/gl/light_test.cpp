// Light in the shader against an independent renderer in double precision: colour matrix, gain, black, response,
// transfer, filter and its domain, ten bits; and pixels that are shown one to one.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/gl/gl_test.h"
#include "tests/gl/plans.h"
#include "viewer/renderer/one_to_one.h"
#include "viewer/renderer/renderer_error.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::viewer {
namespace {

using devices::Image16;
using devices::Image8;
using devices::Size;

const Size kDesktop{331, 257};
const Size kResolution{75, 53};

Image16 smoothMap(Size size, double low, double high) {
  Image16 map(size, 1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double wave = 0.5 + 0.5 * std::sin(0.9 * x + 0.4 * y);
      map.at(x, y) = static_cast<std::uint16_t>(std::lround(65535 * (low + (high - low) * wave)));
    }
  }
  return map;
}

/// One projector, told to the renderer and to the reference.
struct Case {
  OutputPlan plan;
  reference::Job job;
};

Case plainCase() {
  const auto map = testing::homographyMap(kResolution, kDesktop);
  Case made{testing::planOf("p", map, kResolution, kDesktop, 2, 1), {}};
  made.plan.dither = false;
  made.job.resolution = kResolution;
  made.job.desktopFromProjector = reference::mapOfTriangles(testing::gridOf(map, kResolution, 2, 1), kDesktop);
  return made;
}

void addColour(Case& one) {
  // Rows; some colours become negative, others brighter than white.
  one.job.colour = {1.1, -0.2, 0.05, -0.1, 0.9, 0.08, 0.02, -0.15, 0.8};
  std::size_t next = 0;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      one.plan.colour[column][row] = static_cast<float>(one.job.colour.at(next++));
    }
  }
}

void addAlpha(Case& one) {
  one.plan.alpha = smoothMap(kResolution, 0, 1);
  one.job.alpha = [mask = one.plan.alpha](int x, int y) { return mask.at(x, y) / 65535.0; };
}

void addGain(Case& one, Size size) {
  one.plan.gain = smoothMap(size, 0.4, 1);
  one.job.gain = one.plan.gain;
}

void addBlack(Case& one) {
  one.plan.black = smoothMap(kResolution, 0, 1);
  one.plan.largestBlack = {0.0625F, 0.05F, 0.04F};
  one.job.black = [map = one.plan.black](int x, int y) {
    return glm::dvec3(0.0625, 0.05, 0.04) * (map.at(x, y) / 65535.0);
  };
}

void addResponse(Case& one) {
  for (int c = 0; c < 3; ++c) {
    auto& table = one.plan.inverseResponse[static_cast<std::size_t>(c)];
    const int entries = 700 + 312 * c;
    for (int i = 0; i < entries; ++i) {
      table.push_back(static_cast<float>(std::pow(i / (entries - 1.0), 1.1 - 0.1 * c)));
    }
  }
  one.job.deviceCode = [](double light, int c) { return std::pow(light, (1.1 - 0.1 * c) / 2.2); };
}

/// Whether the 3x3 pixels around are all inside or all outside the picture.
bool clearOfEdges(const devices::Image<double>& frame, int x, int y) {
  if (x < 1 || y < 1 || x + 1 >= frame.width() || y + 1 >= frame.height()) return false;
  double sum = 0;
  for (int j = y - 1; j <= y + 1; ++j) {
    for (int i = x - 1; i <= x + 1; ++i) sum += frame.at(i, j, 3);
  }
  return sum == 0 || sum == 9;
}

class LightTest : public testing::GlTest<> {
 protected:
  WallRenderer& draw(const std::vector<OutputPlan>& plans, const Image8& desktop, int bits = 8) {
    renderer_.emplace(context_, RendererOptions{.bitsPerColour = bits});
    renderer_->setPlans(plans);
    renderer_->upload(testing::wholeBatch(desktop));
    renderer_->draw();
    return *renderer_;
  }

  /// How many pixels, edges of the picture aside, differ from the reference by more than one code.
  std::int64_t farPixels(const Case& one, int bits = 8) {
    const auto desktop = testing::testDesktop(kDesktop);
    const auto frame = draw({one.plan}, desktop, bits).readOutputFloat(0);
    auto job = one.job;
    job.highestCode = bits == 10 ? 1023 : 255;
    const auto expected = reference::warp(desktop, job);
    std::int64_t far = 0;
    for (int y = 0; y < frame.height(); ++y) {
      for (int x = 0; x < frame.width(); ++x) {
        if (!clearOfEdges(expected, x, y)) continue;
        double worst = 0;
        for (int c = 0; c < 3; ++c) {
          worst = std::max(worst, std::abs(frame.at(x, y, c) * job.highestCode - expected.at(x, y, c)));
        }
        if (worst > 1) ++far;
      }
    }
    return far;
  }

  std::optional<WallRenderer> renderer_;
};

TEST_F(LightTest, EachPartAloneMatchesTheReference) {
  auto colour = plainCase();
  addColour(colour);
  EXPECT_EQ(farPixels(colour), 0);
  auto black = plainCase();
  addBlack(black);
  EXPECT_EQ(farPixels(black), 0);
  for (const Size size : {Size{1, 1}, Size{7, 5}, Size{2, 90}, kResolution, Size{300, 200}}) {
    auto gain = plainCase();
    addGain(gain, size);
    EXPECT_EQ(farPixels(gain), 0) << size.width << "x" << size.height;
  }
}

TEST_F(LightTest, AllTogetherMatchesTheReferenceInEveryFilterAndTransfer) {
  for (const auto filter : {Filter::kCatmullRom, Filter::kBilinear, Filter::kNearest}) {
    for (const auto domain : {FilterDomain::kSrgb, FilterDomain::kLinear}) {
      for (const bool linear : {false, true}) {
        for (const bool response : {false, true}) {
          auto one = plainCase();
          one.plan.filter = filter;
          one.job.kernel = static_cast<reference::Kernel>(filter);
          one.plan.filterDomain = domain;
          one.plan.transfer = linear ? DesktopTransfer::kLinear : DesktopTransfer::kSrgb;
          one.job.linearDesktop = linear;
          one.job.filterLight = domain == FilterDomain::kLinear && !linear;
          addColour(one);
          addAlpha(one);
          addGain(one, {9, 6});
          addBlack(one);
          if (response) addResponse(one);
          // A nearest texel changes with the last bit of the position: a few pixels may take the neighbour's.
          EXPECT_LE(farPixels(one), filter == Filter::kNearest ? 5 : 0)
              << static_cast<int>(filter) << static_cast<int>(domain) << linear << response;
        }
      }
    }
  }
}

TEST_F(LightTest, TenBitsMatchTheReference) {
  auto one = plainCase();
  addColour(one);
  addAlpha(one);
  addGain(one, {9, 6});
  addBlack(one);
  addResponse(one);
  EXPECT_EQ(farPixels(one, 10), 0);
}

TEST_F(LightTest, TenBitsAreReadAsTheyAre) {
  // A ramp of light over a thousand pixels: more steps than eight bits have.
  const Size size{1000, 4};
  Image8 white(size, 3);
  std::ranges::fill(white.samples(), std::uint8_t{255});
  auto plan = testing::planOf("p", testing::identityMap(), size, size, 1, 1);
  plan.transfer = DesktopTransfer::kLinear;
  plan.dither = false;
  plan.alpha = Image16(size, 1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) plan.alpha.at(x, y) = static_cast<std::uint16_t>(x * 65);
  }
  const auto frame = draw({plan}, white, 10).readOutput16(0);
  for (int x = 0; x < size.width; ++x) {
    const double code = frame.at(x, 2, 1) / 65535.0 * 1023;
    ASSERT_NEAR(code, std::round(code), 0.02) << x;
    ASSERT_NEAR(code, x * 65 / 65535.0 * 1023, 0.52) << x;
  }
  const auto eight = renderer_->readOutput(0);
  EXPECT_NEAR(eight.at(500, 2, 0), 500 * 65 / 257.0, 1);
}

TEST_F(LightTest, WhatChangesNothingChangesNoBit) {
  auto plain = plainCase().plan;
  auto matched = plain;
  matched.gain = Image16({3, 2}, 1);
  std::ranges::fill(matched.gain.samples(), std::uint16_t{65535});
  matched.black = Image16(kResolution, 1);
  for (const bool dither : {false, true}) {
    plain.dither = dither;
    matched.dither = dither;
    auto& renderer = draw({plain, matched}, testing::testDesktop(kDesktop));
    EXPECT_EQ(renderer.readOutput(0), renderer.readOutput(1)) << dither;
  }
}

TEST_F(LightTest, TenBitsKeepEveryCodeOfTheDesktop) {
  const Size size{256, 4};
  Image8 codes(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      for (int c = 0; c < 3; ++c) codes.at(x, y, c) = static_cast<std::uint8_t>(x);
    }
  }
  auto warped = testing::planOf("warped", testing::identityMap(), size, size, 1, 1);
  warped.dither = false;
  auto exact = warped;
  exact.exactAt = glm::ivec2(0, 0);
  auto& renderer = draw({warped, exact}, codes, 10);
  for (const std::size_t i : {0, 1}) {
    EXPECT_EQ(renderer.readOutput(i), codes);
    const auto frame = renderer.readOutput16(i);
    for (int x = 0; x < size.width; ++x) {
      ASSERT_NEAR(frame.at(x, 1, 2), std::round(x / 255.0 * 1023) / 1023 * 65535, 1) << x;
    }
  }
}

/// Columns of black and white, seen half a pixel aside: every pixel is the mean of the two.
TEST_F(LightTest, TheFiltersDomainDecidesWhatIsKeptOfFinePatterns) {
  const Size size{64, 16};
  Image8 stripes(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; x += 2) {
      for (int c = 0; c < 3; ++c) stripes.at(x, y, c) = 255;
    }
  }
  auto inCodes = testing::planOf("p", testing::identityMap({0.5, 0}), {62, 16}, size, 1, 1);
  inCodes.dither = false;
  auto inLight = inCodes;
  inLight.filterDomain = FilterDomain::kLinear;
  auto& renderer = draw({inCodes, inLight}, stripes);
  EXPECT_NEAR(renderer.readOutput(0).at(30, 8, 0), 127.5, 1);
  EXPECT_NEAR(renderer.readOutput(1).at(30, 8, 0), 187.5, 1);  // half the light in sRGB
}

TEST_F(LightTest, ThePointerLooksTheSameInBothDomains) {
  Image8 grey(kDesktop, 3);
  std::ranges::fill(grey.samples(), std::uint8_t{60});
  auto inCodes = plainCase().plan;
  auto inLight = inCodes;
  inLight.filterDomain = FilterDomain::kLinear;
  auto& renderer = draw({inCodes, inLight}, grey);
  const auto bare = renderer.readOutput(1);
  Image8 arrow({40, 40}, 4);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      arrow.at(x, y, 0) = 200;
      arrow.at(x, y, 3) = static_cast<std::uint8_t>((40 * y + x) % 256);
    }
  }
  renderer.setCursor(arrow, {0, 0});
  renderer.moveCursor({150, 120});
  renderer.draw();
  const auto a = renderer.readOutput(0);
  const auto b = renderer.readOutput(1);
  EXPECT_NE(b, bare);
  for (std::size_t i = 0; i < a.samples().size(); ++i) ASSERT_NEAR(a.samples()[i], b.samples()[i], 1);
}

TEST_F(LightTest, PixelsOnPixelsAreNotFiltered) {
  const Size size{300, 200};
  const auto desktop = testing::testDesktop(size);
  const Size resolution{128, 96};
  const auto nearly = [](glm::dvec2 p) { return glm::dvec3(p.x + 17.006, p.y + 40.993, 1); };
  auto plan = testing::planOf("p", nearly, resolution, size, 3, 2);
  plan.dither = false;
  auto masked = plan;
  masked.alpha = Image16(resolution, 1);
  std::ranges::fill(masked.alpha.samples(), std::uint16_t{32768});
  masked.gain = Image16({1, 1}, 1);
  masked.gain.at(0, 0) = 32768;
  masked.transfer = DesktopTransfer::kLinear;
  auto& renderer = draw({plan, masked}, desktop);
  const auto whole = renderer.readOutput(0);
  const auto quarter = renderer.readOutput(1);
  for (int y = 0; y < resolution.height; ++y) {
    for (int x = 0; x < resolution.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const int code = desktop.at(x + 17, y + 41, c);
        ASSERT_EQ(whole.at(x, y, c), code) << x << ", " << y;
        ASSERT_NEAR(quarter.at(x, y, c), code / 4.0, 0.51) << x << ", " << y;
      }
    }
  }
}

TEST(OneToOne, TellsWhichMeshesShowPixelsOnPixels) {
  const Size size{200, 200};
  const auto shows = [&](const testing::WeightedMap& map) {
    return showsPixelsOneToOne(testing::meshOf(testing::gridOf(map, {64, 48}, 2, 3), size));
  };
  EXPECT_TRUE(shows(testing::identityMap()));
  EXPECT_TRUE(shows(testing::identityMap({31, 7})));
  EXPECT_TRUE(shows(testing::identityMap({31.009, 6.991})));
  EXPECT_TRUE(shows([](glm::dvec2 p) { return glm::dvec3(p.y, 100 - p.x, 1); }));  // a quarter turned
  EXPECT_TRUE(shows([](glm::dvec2 p) { return glm::dvec3(90 - p.x, p.y, 1); }));   // mirrored
  EXPECT_TRUE(shows([](glm::dvec2 p) { return glm::dvec3(2.0 * p, 2); }));         // weights that are all alike
  EXPECT_FALSE(shows(testing::identityMap({31.012, 7})));
  EXPECT_FALSE(shows(testing::identityMap({0.5, 0})));
  EXPECT_FALSE(shows([](glm::dvec2 p) { return glm::dvec3(p.x * 1.001, p.y, 1); }));
  EXPECT_FALSE(shows([](glm::dvec2 p) { return glm::dvec3(2.0 * p, 1); }));
  EXPECT_FALSE(shows([](glm::dvec2 p) { return glm::dvec3(p.x + p.y, p.y, 1); }));
  // Right at every corner of the mesh and wrong between them.
  EXPECT_FALSE(shows([](glm::dvec2 p) {
    const double w = 1 + 0.01 * p.x;
    return glm::dvec3(p * w, w);
  }));
  EXPECT_FALSE(showsPixelsOneToOne({}));
}

TEST_F(LightTest, PlansWhoseLightIsNotSoundAreErrors) {
  std::vector<OutputPlan> wrong(5, plainCase().plan);
  wrong[0].gain = Image16({4, 4}, 3);
  wrong[1].black = Image16({4, 4}, 1);
  wrong[2].black = Image16(kResolution, 3);
  wrong[3].colour[1][1] = std::numeric_limits<float>::quiet_NaN();
  wrong[4].largestBlack.y = std::numeric_limits<float>::infinity();
  for (const auto& plan : wrong) {
    WallRenderer renderer(context_);
    EXPECT_THROW(renderer.setPlans({plan}), RendererError);
  }
}

}  // namespace
}  // namespace pixelflex::viewer
