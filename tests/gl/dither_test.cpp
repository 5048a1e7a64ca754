// What dithering is for: dark greys through a blend, in eight bits, as an eye sees them from the seats.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/gl/gl_test.h"
#include "tests/gl/plans.h"
#include "viewer/renderer/dither_tile.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::viewer {
namespace {

using devices::Image16;
using devices::Image8;
using devices::Size;
using Light = devices::Image<double>;

constexpr double kGamma = 2.2;
constexpr int kBlend = 200;  // pixels
const Size kFrame{280, 96};
const glm::ivec2 kSecondAt(37, 11);  // where the second projector's frame is on the first's pixels

double lightOf(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

/// Falls from 1 to 0 as half a cosine, in pixels of the first projector.
double fading(double x) {
  const double t = std::clamp((x - (kFrame.width - kBlend) / 2.0) / kBlend, 0.0, 1.0);
  return 0.5 + 0.5 * std::cos(M_PI * t);
}

/// Two projectors with the same gamma that show one grey, each faded out where the other comes in.
std::vector<OutputPlan> blendedPair() {
  std::vector<OutputPlan> plans;
  const Size desktop{kFrame.width + kSecondAt.x, kFrame.height + kSecondAt.y};
  for (const glm::ivec2 at : {glm::ivec2(0, 0), kSecondAt}) {
    auto plan = testing::planOf("p", testing::identityMap(at), kFrame, desktop, 1, 1);
    plan.alpha = Image16(kFrame, 1);
    for (int y = 0; y < kFrame.height; ++y) {
      for (int x = 0; x < kFrame.width; ++x) {
        const double share = fading(x + at.x + 0.5);
        plan.alpha.at(x, y) = static_cast<std::uint16_t>(std::lround(65535 * (plans.empty() ? share : 1 - share)));
      }
    }
    for (auto& channel : plan.inverseResponse) {
      for (int i = 0; i < 1024; ++i) channel.push_back(static_cast<float>(i / 1023.0));
    }
    plans.push_back(plan);
  }
  return plans;
}

Light added(const std::array<Light, 2>& frames) {
  Light sum({kFrame.width - kSecondAt.x, kFrame.height - kSecondAt.y}, 1);
  for (int y = 0; y < sum.height(); ++y) {
    for (int x = 0; x < sum.width(); ++x) {
      sum.at(x, y) = frames[0].at(x + kSecondAt.x, y + kSecondAt.y) + frames[1].at(x, y);
    }
  }
  return sum;
}

/// The eye: a Gaussian with a standard deviation of two pixels; the borders are left out.
Light seen(const Light& sharp) {
  constexpr int kReach = 8;
  const auto weight = [](int d) { return std::exp(-d * d / 8.0); };
  double whole = 0;
  for (int d = -kReach; d <= kReach; ++d) whole += weight(d);
  Light across({sharp.width() - 2 * kReach, sharp.height()}, 1);
  for (int y = 0; y < across.height(); ++y) {
    for (int x = 0; x < across.width(); ++x) {
      for (int d = 0; d <= 2 * kReach; ++d) across.at(x, y) += weight(d - kReach) / whole * sharp.at(x + d, y);
    }
  }
  Light both({across.width(), across.height() - 2 * kReach}, 1);
  for (int y = 0; y < both.height(); ++y) {
    for (int x = 0; x < both.width(); ++x) {
      for (int d = 0; d <= 2 * kReach; ++d) both.at(x, y) += weight(d - kReach) / whole * across.at(x, y + d);
    }
  }
  return both;
}

/// RMS of the relative error of what is seen; the light asked for is the same everywhere.
double banding(const std::array<Light, 2>& frames, int code) {
  const auto light = seen(added(frames));
  double sum = 0;
  for (const double sample : light.samples()) {
    const double error = sample / lightOf(code / 255.0) - 1;
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<double>(light.samples().size()));
}

class DitherTest : public testing::GlTest<> {
 protected:
  std::array<Light, 2> rendered(int code, int bits, bool dither) {
    auto plans = blendedPair();
    for (auto& plan : plans) plan.dither = dither;
    WallRenderer renderer(context_, {.bitsPerColour = bits});
    renderer.setPlans(plans);
    Image8 grey(plans[0].desktop, 3);
    std::ranges::fill(grey.samples(), static_cast<std::uint8_t>(code));
    renderer.upload(testing::wholeBatch(grey));
    renderer.draw();
    std::array<Light, 2> light{Light(kFrame, 1), Light(kFrame, 1)};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto frame = renderer.readOutputFloat(i);
      for (int y = 0; y < kFrame.height; ++y) {
        for (int x = 0; x < kFrame.width; ++x) light[i].at(x, y) = std::pow(frame.at(x, y, 1), kGamma);
      }
    }
    return light;
  }
};

/// Blending in eight bits of light, then a table of 256 codes, as in PixelFlex's first description.
std::array<Light, 2> eightBitTables(int code) {
  const auto plans = blendedPair();
  std::array<Light, 2> light{Light(kFrame, 1), Light(kFrame, 1)};
  for (std::size_t i = 0; i < 2; ++i) {
    for (int y = 0; y < kFrame.height; ++y) {
      for (int x = 0; x < kFrame.width; ++x) {
        const double blended = std::round(255 * lightOf(code / 255.0) * plans[i].alpha.at(x, y) / 65535.0) / 255;
        light[i].at(x, y) = std::pow(std::round(255 * std::pow(blended, 1 / kGamma)) / 255, kGamma);
      }
    }
  }
  return light;
}

TEST_F(DitherTest, BandingThroughABlend) {
  fmt::print("banding through a blend, RMS in per cent after an eye's blur of 2 px\n");
  fmt::print("{:>5} {:>14} {:>10} {:>10} {:>10}\n", "code", "8-bit tables", "undithered", "dithered", "10 bits");
  for (const auto& [code, most] : {std::pair{8, 0.03}, {16, 0.01}, {32, 0.006}, {64, 0.004}, {128, 0.002}}) {
    const double tables = banding(eightBitTables(code), code);
    const double plain = banding(rendered(code, 8, false), code);
    const double dithered = banding(rendered(code, 8, true), code);
    const double ten = banding(rendered(code, 10, true), code);
    fmt::print("{:>5} {:>14.3f} {:>10.3f} {:>10.3f} {:>10.3f}\n", code, 100 * tables, 100 * plain, 100 * dithered,
               100 * ten);
    EXPECT_LE(dithered, most) << code;
    EXPECT_LT(dithered, plain) << code;
    EXPECT_LT(plain, tables) << code;
    EXPECT_LE(ten, dithered / 2) << code;
  }
}

TEST_F(DitherTest, TenBitsKeepTheMeanAndTheEnds) {
  const Size size{128, 128};
  for (const double wanted : {0.0, 20.25, 500.5, 1023.0}) {
    Image8 white(size, 3);
    std::ranges::fill(white.samples(), std::uint8_t{255});
    auto plan = testing::planOf("p", testing::identityMap(), size, size, 1, 1);
    plan.transfer = DesktopTransfer::kLinear;
    plan.alpha = Image16(size, 1);
    std::ranges::fill(plan.alpha.samples(), static_cast<std::uint16_t>(std::lround(wanted / 1023 * 65535)));
    WallRenderer renderer(context_, {.bitsPerColour = 10});
    renderer.setPlans({plan});
    renderer.upload(testing::wholeBatch(white));
    renderer.draw();
    const auto frame = renderer.readOutputFloat(0);
    double sum = 0;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const double code = 1023.0 * frame.at(x, y, 1);
        ASSERT_NEAR(code, wanted, 1.01);
        sum += code;
      }
    }
    const bool end = wanted == 0 || wanted == 1023;
    EXPECT_NEAR(sum / static_cast<double>(size.area()), wanted, end ? 1e-4 : 0.02);
  }
}

TEST(DitherTile, HasEveryValueEquallyOften) {
  const auto tile = makeDitherTile();
  ASSERT_EQ(tile.size(), (Size{kDitherExtent, kDitherExtent}));
  for (int c = 0; c < 3; ++c) {
    std::array<int, 256> count{};
    for (int y = 0; y < tile.height(); ++y) {
      for (int x = 0; x < tile.width(); ++x) ++count.at(tile.at(x, y, c));
    }
    for (const int times : count) ASSERT_EQ(times, kDitherExtent * kDitherExtent / 256);
  }
}

/// Spread of the means of 4x4 blocks, tile borders crossed, as a share of what independent values would have.
double clumping(const Image8& tile, int channel) {
  double sum = 0;
  for (int y = 0; y < tile.height(); ++y) {
    for (int x = 0; x < tile.width(); ++x) {
      double mean = 0;
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) mean += tile.at((x + i) % tile.width(), (y + j) % tile.height(), channel) / 16.0;
      }
      sum += (mean - 127.5) * (mean - 127.5);
    }
  }
  const double independent = (256.0 * 256.0 - 1) / 12 / 16;
  return std::sqrt(sum / static_cast<double>(tile.size().area()) / independent);
}

TEST(DitherTile, HasNoClumpsAndNoRows) {
  const auto tile = makeDitherTile();
  for (int c = 0; c < 3; ++c) EXPECT_LT(clumping(tile, c), 0.5);
  // No direction stands out: neighbours differ alike across, down and along both diagonals.
  const auto likeness = [&](int dx, int dy) {
    double sum = 0;
    for (int y = 0; y < tile.height(); ++y) {
      for (int x = 0; x < tile.width(); ++x) {
        const int other = tile.at((x + dx + tile.width()) % tile.width(), (y + dy) % tile.height());
        sum += (tile.at(x, y) - 127.5) * (other - 127.5);
      }
    }
    return sum / static_cast<double>(tile.size().area()) / ((256.0 * 256.0 - 1) / 12);
  };
  EXPECT_NEAR(likeness(1, 0), likeness(0, 1), 0.1);
  EXPECT_NEAR(likeness(1, 1), likeness(-1, 1), 0.1);
  EXPECT_LT(likeness(1, 0), 0);
}

}  // namespace
}  // namespace pixelflex::viewer
