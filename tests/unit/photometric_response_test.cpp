#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "calib/photometric/monotone.h"
#include "calib/photometric/response_curve.h"

namespace pixelflex::calib {
namespace {

using Light = std::function<double(double code01)>;

/// Readings of one response in all channels, with relative noise and a leak.
std::string readings(const Light& light, double noise = 0, double scale = 80) {
  std::mt19937 random(11);
  std::normal_distribution<double> error(0, noise);
  std::string csv = "value,red,green,blue\n";
  for (int v = 0; v < 256; ++v) {
    csv += std::to_string(v);
    for (int c = 0; c < 3; ++c) {
      csv += "," + std::to_string(scale * std::max(0.0, (0.002 + light(v / 255.0)) * (1 + error(random))));
    }
    csv += "\n";
  }
  return csv;
}

Light power(double gamma, double toe = 0, double clip = 1) {
  return [=](double v) { return std::pow(std::clamp((v - toe) / (clip - toe), 0.0, 1.0), gamma); };
}

double sShaped(double v) {
  return v * v * v / (v * v * v + (1 - v) * (1 - v) * (0.4 + 0.6 * v));
}

/// RMS over codes 20 to 235 of the error relative to light, with a floor of 1 % of white.
double errorOf(const std::array<double, 256>& light, const Light& truth) {
  double sum = 0;
  for (std::size_t v = 20; v <= 235; ++v) {
    const double wanted = truth(double(v) / 255);
    sum += std::pow((light.at(v) - wanted) / std::max(wanted, 0.01), 2);
  }
  return std::sqrt(sum / 216);
}

/// What the device shows for `light` through the LUT.
double shown(const std::vector<float>& inverse, double light, const Light& device) {
  const double at = std::pow(light, 1 / 2.2) * double(kInverseEntries - 1);
  const auto i = std::min(static_cast<std::size_t>(at), inverse.size() - 2);
  const double f = at - double(i);
  return device(inverse[i] * (1 - f) + inverse[i + 1] * f);
}

TEST(Readings, CurvesOfAllShapesAreFollowed) {
  for (const Light& light : {power(1.9), power(2.5), power(2.2, 0.05), power(2.2, 0, 0.8), Light(sShaped)}) {
    const auto curve = parseReadings(readings(light), "p1.csv");
    for (const auto& channel : curve.light) EXPECT_LT(errorOf(channel, light), 1e-4);
  }
}

TEST(Readings, ToeAndShoulderOfEachChannel) {
  const Light device = power(2.2, 0.06, 0.85);
  const auto curve = parseReadings(readings(device), "p1.csv");
  for (const auto& channel : curve.light) {
    const auto inverse = inverseResponse(channel);
    EXPECT_TRUE(std::ranges::is_sorted(inverse));
    EXPECT_EQ(inverse.front(), 0);
    EXPECT_EQ(inverse.back(), 1);
    EXPECT_GT(inverse[1], 0.055);  // tones begin at the toe's end
    EXPECT_LE(inverse[kInverseEntries - 2], 0.851);
    for (double light = 0.001; light < 1; light *= 1.1) {
      EXPECT_NEAR(shown(inverse, light, device), light, 0.01 * light + 1e-4);
    }
  }
}

TEST(Readings, NoiseIsTakenOut) {
  const std::vector<std::pair<Light, double>> cases = {
      {power(1.9), 0.005}, {power(2.5, 0.04), 0.005}, {power(2.2, 0, 0.85), 0.012}, {sShaped, 0.012}};
  for (const auto& [light, limit] : cases) {
    const auto noisy = parseReadings(readings(light, 0.01), "p1.csv");
    const auto smooth = withoutNoise(noisy);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_LT(errorOf(smooth.light.at(c), light), limit);
      EXPECT_TRUE(std::ranges::is_sorted(smooth.light.at(c)));
      EXPECT_EQ(smooth.light.at(c).front(), 0);
      EXPECT_EQ(smooth.light.at(c).back(), 1);
    }
    EXPECT_EQ(parseReadings(formatReadings(smooth), "p1.csv").light[0], smooth.light[0]);
  }
  const auto exact = parseReadings(readings(power(2.2, 0.05, 0.9)), "p1.csv");
  EXPECT_EQ(withoutNoise(exact), exact);
}

TEST(Readings, HeadersCommentsAndSpreadsheets) {
  const std::string rows = readings(power(2)).substr(std::string("value,red,green,blue\n").size());
  const auto plain = parseReadings(rows, "p1.csv");
  for (const std::string header :
       {"Level,R,G,B\n", "\xEF\xBB\xBFValue, Red, Green, Blue\r\n", "# cd/m2\n\nvalue,red,green,blue\n"}) {
    EXPECT_EQ(parseReadings(header + rows, "p1.csv"), plain) << header;
  }
}

void expectRefused(const std::string& csv, const std::string& words) {
  try {
    (void)parseReadings(csv, "p1.csv");
    ADD_FAILURE() << "accepted where it should say: " << words;
  } catch (const ResponseError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find("p1.csv:"), 0U) << error.what();
  }
}

std::string withRow(std::string csv, int code, const std::string& row) {
  const auto at = csv.find("\n" + std::to_string(code) + ",") + 1;
  return csv.replace(at, csv.find('\n', at) - at, row);
}

TEST(Readings, BadOnesAreRefusedWithTheLine) {
  const std::string good = readings(power(2.2));
  expectRefused(withRow(good, 7, "7,1,nan,1"), "p1.csv:9: expected a number, found \"nan\"");
  expectRefused(withRow(good, 7, "7,1,inf,1"), "p1.csv:9: expected a number");
  expectRefused(withRow(good, 7, "7,1,-0.5,1"), "p1.csv:9: light cannot be negative");
  expectRefused(withRow(good, 7, "7,1,two,1"), "p1.csv:9: expected a number");
  expectRefused(withRow(good, 7, "7;1;1;1"), "p1.csv:9: expected four columns value,red,green,blue, found 1");
  expectRefused(good.substr(0, good.find("\n200,") + 1), "expected 256 readings, found 200");
  expectRefused("Dear sir,\nthe projector\nis fine\n", "p1.csv:1: expected four columns");
  expectRefused("red,green,blue,value\n" + good, "p1.csv:1: expected the columns in the order value,red,green,blue");
  expectRefused("value,blue,green,red\n" + good, "\"blue\" in column 2");
}

TEST(Readings, CurvesThatAreNoResponseAreRefused) {
  expectRefused(readings([](double v) { return 1 - v; }), "do not rise");
  expectRefused(readings([](double v) { return v < 0.7 ? v : 1.2 - v; }), "fall, near value");
  expectRefused(withRow(readings(power(2.2)), 128, "128,0,0,0"), "the red readings fall, near value 1");
  expectRefused(withRow(readings(power(2.2)), 40, "40,30,1,1"), "the red readings fall, near value");
  expectRefused(readings(power(2.2, 0, 0.6)), "are clipped from value 15");
  expectRefused(readings(power(2.2, 0.5)), "stay at black up to value 13");
}

TEST(Monotone, LevelsAsLeastSquaresDoes) {
  std::vector<double> values = {1, 3, 2, 2, 5, 4, 6};
  levelFalls(values);
  const std::vector<double> expected = {1, 7.0 / 3, 7.0 / 3, 7.0 / 3, 4.5, 4.5, 6};
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_DOUBLE_EQ(values[i], expected[i]);
  std::vector<double> weighted = {4, 0};
  levelFalls(weighted, std::vector<double>{3, 1});
  EXPECT_EQ(weighted, (std::vector<double>{3, 3}));
}

TEST(Monotone, InterpolatesWithoutOvershoot) {
  const std::vector<double> at = {0, 1, 2, 4, 5};
  const std::vector<double> values = {0, 0, 1, 1.1, 7};
  std::vector<double> wanted;
  for (double x = -0.5; x <= 5.5; x += 0.01) wanted.push_back(x);
  const auto curve = interpolateMonotone(at, values, wanted);
  EXPECT_TRUE(std::ranges::is_sorted(curve));
  EXPECT_EQ(curve.front(), 0);
  EXPECT_EQ(curve.back(), 7);
  EXPECT_EQ(interpolateMonotone(at, values, at), values);
}

TEST(Monotone, InterpolatesAParabolaClosely) {
  std::vector<double> at;
  std::vector<double> values;
  for (int i = 0; i <= 20; ++i) {
    at.push_back(i);
    values.push_back(i * i);
  }
  const auto curve = interpolateMonotone(at, values, std::vector<double>{7.3, 14.5, 19.9});
  EXPECT_NEAR(curve[0], 7.3 * 7.3, 0.01);
  EXPECT_NEAR(curve[1], 14.5 * 14.5, 0.01);
  EXPECT_NEAR(curve[2], 19.9 * 19.9, 0.01);
}

}  // namespace
}  // namespace pixelflex::calib
