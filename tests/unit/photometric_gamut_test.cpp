#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "calib/photometric/gamut.h"
#include "calib/photometric/light_error.h"

namespace pixelflex::calib {
namespace {

constexpr Matrix3 kIdentity = {1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr Matrix3 kProjector = {0.90, 0.12, 0.03, 0.10, 0.85, 0.09, 0.02, 0.10, 0.95};

Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 c{};
  for (std::size_t i = 0; i < 9; ++i) {
    for (std::size_t k = 0; k < 3; ++k) c.at(i) += a.at(i / 3 * 3 + k) * b.at(k * 3 + i % 3);
  }
  return c;
}

/// White levels +-15 %, gains +-8 % a channel, primaries a little different.
std::vector<Matrix3> unlike(unsigned seed, int count, double primaries = 0.02) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-1, 1);
  std::vector<Matrix3> all;
  for (int i = 0; i < count; ++i) {
    Matrix3 m = kProjector;
    const double level = 1 + 0.15 * part(random);
    for (std::size_t c = 0; c < 3; ++c) {
      const double gain = level * (1 + 0.08 * part(random));
      for (std::size_t r = 0; r < 3; ++r) m.at(3 * r + c) = gain * (m.at(3 * r + c) + primaries * part(random));
    }
    all.push_back(m);
  }
  return all;
}

TEST(CommonGamut, AllProjectorsMakeTheSameColours) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto primaries = unlike(seed, 8);
    const auto gamut = commonGamut(primaries);
    for (std::size_t m = 0; m < primaries.size(); ++m) {
      const auto& match = gamut.projectors[m];
      const Matrix3 made = product(primaries[m], match.colour);
      for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(made.at(i), match.scale * gamut.target.at(i), 1e-9);
    }
    EXPECT_LT(gamut.desaturation, 0.25);
  }
}

TEST(CommonGamut, NothingIsClippedAndNoLightGivenAway) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const auto& match : commonGamut(unlike(seed, 6)).projectors) {
      double brightest = 0;
      for (std::size_t row = 0; row < 3; ++row) {
        double sum = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_GE(match.colour.at(3 * row + c), 0);
          sum += match.colour.at(3 * row + c);
        }
        brightest = std::max(brightest, sum);
      }
      EXPECT_NEAR(brightest, 1, 1e-12);  // the scarcest channel is used in full
      EXPECT_GT(match.kept, 0.84);
      EXPECT_LE(match.kept, 1.0001);
    }
  }
}

TEST(CommonGamut, KeptIsTheLuminanceOfWhite) {
  const auto primaries = unlike(5, 4);
  const auto gamut = commonGamut(primaries);
  const auto luminance = [](const Matrix3& m) {
    double sum = 0;
    for (std::size_t i = 0; i < 9; ++i) sum += kCameraLuminance.at(i / 3) * m.at(i);
    return sum;
  };
  EXPECT_NEAR(luminance(gamut.target), 1, 1e-12);
  for (std::size_t m = 0; m < primaries.size(); ++m) {
    const double made = luminance(product(primaries[m], gamut.projectors[m].colour));
    EXPECT_NEAR(made / luminance(primaries[m]), gamut.projectors[m].kept, 1e-12);
    EXPECT_NEAR(made, gamut.projectors[m].scale, 1e-12);
  }
}

TEST(CommonGamut, ProjectorsThatAreAlikeGetTheIdentity) {
  auto dimmer = kProjector;
  for (double& value : dimmer) value *= 0.8;  // the level is the luminance target's business
  const auto gamut = commonGamut(std::vector<Matrix3>{kProjector, dimmer, kProjector});
  for (const auto& match : gamut.projectors) {
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(match.colour.at(i), kIdentity.at(i), 1e-12);
    EXPECT_NEAR(match.kept, 1, 1e-12);
  }
  EXPECT_NEAR(gamut.desaturation, 0, 1e-12);
}

TEST(CommonGamut, GainsAloneScaleTheChannels) {
  const auto gamut = commonGamut(unlike(3, 5, 0));
  for (const auto& match : gamut.projectors) {
    for (std::size_t i = 0; i < 9; ++i) {
      if (i % 4 != 0) {
        EXPECT_NEAR(match.colour.at(i), 0, 1e-12);
      }
    }
  }
  EXPECT_NEAR(gamut.desaturation, 0, 1e-12);
}

TEST(CommonGamut, RefusesWhatSpansNoColour) {
  EXPECT_THROW((void)commonGamut(std::vector<Matrix3>{kProjector, Matrix3{}}), LightError);
  EXPECT_THROW((void)commonGamut(std::vector<Matrix3>{{1, 1, 1, 1, 1, 1, 1, 1, 1}}), LightError);
  EXPECT_THROW((void)commonGamut(std::vector<Matrix3>{{-1, 0, 0, 0, 1, 0, 0, 0, 1}}), LightError);
  Matrix3 swapped = kProjector;  // red and blue fields mixed up
  for (std::size_t row = 0; row < 3; ++row) std::swap(swapped.at(3 * row), swapped.at(3 * row + 2));
  EXPECT_THROW((void)commonGamut(std::vector<Matrix3>{kProjector, swapped}), LightError);
}

}  // namespace
}  // namespace pixelflex::calib
