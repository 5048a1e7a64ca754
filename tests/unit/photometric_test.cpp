#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "calib/photometric/mask.h"
#include "calib/photometric/response_curve.h"

namespace pixelflex::calib {
namespace {

ProjectorModel at(double left, double top, double pixelsPerUnit) {
  return {.projectorFromWall = {pixelsPerUnit, 0.01, -left * pixelsPerUnit, 0.005, pixelsPerUnit, -top * pixelsPerUnit,
                                1e-6, 2e-6, 1},
          .centre = {0, 0},
          .scale = 1};
}

class BlendTest : public ::testing::Test {
 protected:
  const std::vector<ProjectorMapping> projectors_ = {ProjectorMapping(at(0, 0, 1), {400, 300}),
                                                     ProjectorMapping(at(320, 20, 1), {400, 300}),
                                                     ProjectorMapping(at(150, 240, 1.5), {400, 300})};
  std::vector<double> densities_;
  void SetUp() override {
    for (const auto& projector : projectors_) densities_.push_back(projector.meanDensity());
  }
};

TEST_F(BlendTest, SharesSumToOneWhereverThereIsLight) {
  for (double y = 5; y < 400; y += 7) {
    for (double x = 5; x < 700; x += 7) {
      const auto shares = blendShares({x, y}, projectors_, densities_, {});
      bool lit = false;
      for (const auto& projector : projectors_) {
        const auto p = projector.projectorFromWall({x, y});
        lit = lit || (p && edgeWeight(*p, projector.resolution()) > 0);
      }
      const double sum = shares[0] + shares[1] + shares[2];
      EXPECT_NEAR(sum, lit ? 1 : 0, 1e-12) << x << " " << y;
    }
  }
}

TEST_F(BlendTest, MasksAreTheSharesOfEachPixel) {
  for (std::size_t i = 0; i < projectors_.size(); ++i) {
    const auto mask = alphaMask(i, projectors_, densities_, {});
    ASSERT_EQ(mask.size(), projectors_[i].resolution());
    for (int y = 1; y < 300; y += 37) {
      for (int x = 1; x < 400; x += 37) {
        const auto wall = projectors_[i].wallFromProjector({x + 0.5, y + 0.5});
        const double expected = blendShares(*wall, projectors_, densities_, {})[i];
        EXPECT_NEAR(mask.at(x, y) / 65535.0, expected, 1e-5);
      }
    }
  }
}

TEST_F(BlendTest, AloneAProjectorHasAllTheLight) {
  const auto mask = alphaMask(0, projectors_, densities_, {});
  EXPECT_EQ(mask.at(0, 0), 65535);  // even on its own border
  EXPECT_EQ(mask.at(50, 50), 65535);
}

TEST_F(BlendTest, TheDenserProjectorWinsWithTheExponent) {
  const glm::dvec2 shared{250, 270};  // lit by the first and the denser third
  double before = 0;
  for (const double exponent : {0.0, 1.0, 2.0, 4.0}) {
    const double third = blendShares(shared, projectors_, densities_, {.densityExponent = exponent})[2];
    EXPECT_GT(third, before);
    before = third;
  }
}

TEST(EdgeWeight, RisesSmoothlyFromTheEdge) {
  EXPECT_EQ(edgeWeight({0, 100}, {400, 300}), 0);
  EXPECT_EQ(edgeWeight({-5, 100}, {400, 300}), 0);
  EXPECT_EQ(edgeWeight({200, 150}, {400, 300}), 1);
  double steepest = 0;
  for (double x = 0; x < 399; ++x) {
    steepest = std::max(steepest, std::abs(edgeWeight({x + 1, 150}, {400, 300}) - edgeWeight({x, 150}, {400, 300})));
  }
  EXPECT_LT(steepest, 0.021);  // 1.5 / 75 px
}

std::string readings(double gamma, double noise, double scale = 120, double black = 0.3) {
  std::mt19937 random(7);
  std::normal_distribution<double> error(0, noise);
  std::string csv = "value,red,green,blue\n";
  for (int v = 0; v < 256; ++v) {
    const double light = black + scale * std::pow(v / 255.0, gamma);
    csv += std::to_string(v);
    for (int c = 0; c < 3; ++c) csv += "," + std::to_string(std::max(0.0, light * (1 + error(random))));
    csv += "\n";
  }
  return csv;
}

TEST(ResponseCurve, InverseLinearisesEveryCode) {
  for (const double gamma : {1.0, 1.9, 2.2, 2.5}) {
    const ResponseCurve curve = parseReadings(readings(gamma, 0), "p1.csv");
    const auto inverse = inverseResponse(curve.light[1]);
    for (double light = 0.002; light <= 1; light += 0.01) {
      // Look up as the shader does, then ask the true response.
      const double at = std::pow(light, 1 / 2.2) * double(kInverseEntries - 1);
      const auto i = static_cast<std::size_t>(at);
      const double f = at - double(i);
      const double code = i + 1 < inverse.size() ? inverse[i] * (1 - f) + inverse[i + 1] * f : inverse[i];
      EXPECT_NEAR(std::pow(code, gamma), light, 0.005 * light + 1e-4) << gamma;
    }
  }
}

TEST(ResponseCurve, NoiseNeverMakesItFall) {
  const ResponseCurve curve = parseReadings(readings(2.2, 0.01), "p1.csv");
  for (const auto& light : curve.light) {
    EXPECT_DOUBLE_EQ(light[0], 0);
    EXPECT_DOUBLE_EQ(light[255], 1);
    for (std::size_t i = 1; i < 256; ++i) EXPECT_GE(light[i], light[i - 1]);
  }
}

TEST(ResponseCurve, SurvivesItsOwnFormat) {
  const ResponseCurve curve = parseReadings(readings(2.0, 0.002), "p1.csv");
  const ResponseCurve again = parseReadings(formatReadings(curve), "p1.csv");
  for (std::size_t i = 0; i < 256; ++i) EXPECT_NEAR(again.light[0][i], curve.light[0][i], 1e-12);
}

TEST(ResponseCurve, InverseHandlesAFlatFootAndClipping) {
  std::array<double, 256> light{};
  for (std::size_t i = 0; i < 256; ++i) light[i] = std::clamp((double(i) - 20) / 200, 0.0, 1.0);
  const auto inverse = inverseResponse(light);
  EXPECT_EQ(inverse.front(), 0);
  EXPECT_EQ(inverse.back(), 1);
  for (std::size_t i = 1; i < inverse.size(); ++i) EXPECT_GE(inverse[i], inverse[i - 1]);
  const double half = inverse[static_cast<std::size_t>(std::lround(std::pow(0.5, 1 / 2.2) * (kInverseEntries - 1)))];
  EXPECT_NEAR(half * 255, 120, 0.3);
}

void expectRefused(const std::string& csv, const std::string& words) {
  try {
    (void)parseReadings(csv, "readings/p1.csv");
    FAIL() << "accepted";
  } catch (const ResponseError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("readings/p1.csv"), std::string::npos) << error.what();
  }
}

TEST(ResponseCurve, RefusesWhatIsNoResponse) {
  expectRefused("", "found 0");
  expectRefused("0,1,1,1\n1,2,2\n", ":2:");
  expectRefused("0,1,1,1\n2,2,2,2\n", ":2:");
  expectRefused("0,1,1,-1\n", ":1: light cannot be negative");
  std::string flat;
  for (int v = 0; v < 256; ++v) flat += std::to_string(v) + ",1,1,1\n";
  expectRefused(flat, "do not rise");
  expectRefused(flat + "256,1,1,1\n", ":257:");
}

}  // namespace
}  // namespace pixelflex::calib
