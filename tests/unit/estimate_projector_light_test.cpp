#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "calib/estimate/intrinsics.h"
#include "calib/estimate/projector_response.h"
#include "calib/patterns/response_pattern.h"
#include "tests/unit/test_camera.h"

namespace pixelflex::calib {
namespace {

using Device = std::function<double(double code01)>;

Device power(double gamma, double toe, double clip = 1) {
  return [=](double v) { return std::pow(std::clamp((v - toe) / (clip - toe), 0.0, 1.0), gamma); };
}

double sShaped(double v) {
  return std::pow(v, 1.6) * (1 - 0.35 * std::pow(1 - v, 2)) / (1 + 0.4 * (1 - v) * v);
}

/// A projector before a camera, each with its own colours; room light and leak.
struct Bench {
  TestCamera camera{bentFromLight};
  Device device = power(2.2, 0.03);
  double leak = 0.003;
  double room = 0.002;

  [[nodiscard]] double light(int cameraChannel, std::array<double, 3> drive) const {
    constexpr double kMix[3][3] = {{0.80, 0.15, 0.05}, {0.12, 0.75, 0.13}, {0.04, 0.11, 0.85}};
    double sum = room;
    for (int p = 0; p < 3; ++p) {
      sum += 0.8 * kMix[cameraChannel][p] * (leak + (1 - leak) * drive.at(static_cast<std::size_t>(p)));
    }
    return sum;
  }

  [[nodiscard]] PatchLight patch(std::array<double, 3> drive, const CameraResponse& response, std::mt19937& random,
                                 double leakPart = 1) const {
    std::vector<ExposedPhoto> photos;
    for (const double exposure : {0.7, 4.0, 24.0, 140.0}) {
      photos.push_back(camera.shoot(
          {24, 20}, exposure,
          [&](int x, int, int c) {
            const double even = 1 - 0.002 * x;
            return leakPart > 0 ? even * light(c, drive) : room;
          },
          random));
    }
    return patchLight(photos, response);
  }

  [[nodiscard]] ResponseSeries series(const CameraResponse& response, unsigned seed) const {
    std::mt19937 random(seed);
    ResponseSeries all;
    for (std::size_t p = 0; p < 3; ++p) {
      for (const int code : responseLevels()) {
        std::array<double, 3> drive{};
        drive.at(p) = device(code / 255.0);
        all.levels.at(p).push_back({code, patch(drive, response, random)});
      }
    }
    all.black = patch({0, 0, 0}, response, random);
    all.ambient = patch({0, 0, 0}, response, random, 0);
    return all;
  }
};

CameraResponse measuredCamera(const TestCamera& camera) {
  std::mt19937 random(4);
  std::vector<ExposedPhoto> photos;
  for (int i = 0; i < 8; ++i) {
    photos.push_back(camera.shoot(
        {160, 120}, std::exp2(i - 4.0),
        [](int x, int y, int) { return (x > 130 ? 0.02 : 0.7) * (1 - 0.004 * x) * (1 - 0.005 * y); }, random));
  }
  return estimateCameraResponse(photos);
}

double errorOf(const std::array<double, 256>& light, const Device& device) {
  double sum = 0;
  for (std::size_t code = 20; code <= 235; ++code) {
    const double truth = device(double(code) / 255);
    sum += std::pow((light.at(code) - truth) / std::max(truth, 0.01), 2);
  }
  return std::sqrt(sum / 216);
}

TEST(ProjectorResponseTest, IsRecoveredThroughAnUnknownCamera) {
  const CameraResponse camera = measuredCamera(Bench().camera);
  unsigned seed = 1;
  for (const Device& device :
       {power(1.9, 0), power(2.2, 0.03), power(2.5, 0.05), power(2.2, 0, 0.9), Device(sShaped)}) {
    Bench bench;
    bench.device = device;
    const auto found = projectorResponse(bench.series(camera, seed++));
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_LT(errorOf(found.curve.light.at(c), device), 0.006);
      EXPECT_LT(errorOf(found.curve.light.at(c), device), 3 * found.error.at(c) + camera.error + 0.002);
      EXPECT_LT(found.error.at(c), 0.006);
      EXPECT_TRUE(std::ranges::is_sorted(found.curve.light.at(c)));
      EXPECT_EQ(found.curve.light.at(c).front(), 0);
      EXPECT_NEAR(found.curve.light.at(c).back(), 1, 1e-12);
    }
    EXPECT_NEAR(found.leak.value(), bench.leak, 0.0003);
  }
}

TEST(ProjectorResponseTest, ReadingsFileTakesItAsItIs) {
  const auto found = projectorResponse(Bench().series(measuredCamera(Bench().camera), 9));
  EXPECT_NO_THROW((void)parseReadings(formatReadings(found.curve), "p1.csv"));
}

/// Light without noise: every channel of the camera sees a third.
ResponseSeries exact(const Device& device, const std::vector<int>& codes = responseLevels()) {
  ResponseSeries series;
  for (auto& levels : series.levels) {
    for (const int code : codes) {
      const double light = 0.01 + device(code / 255.0) / 3;
      if (code > 0) levels.push_back({code, {.light = {light, light, light}, .deviation = {}, .clipped = 0}});
    }
  }
  series.black.light = {0.01, 0.01, 0.01};
  return series;
}

TEST(ProjectorResponseTest, GapsBetweenLevelsCostLittle) {
  for (const Device& device : {power(1.9, 0), power(2.2, 0), power(2.5, 0), Device(sShaped)}) {
    const auto found = projectorResponse(exact(device));
    for (const auto& light : found.curve.light) EXPECT_LT(errorOf(light, device), 0.002);
    EXPECT_FALSE(found.leak);
  }
  std::vector<int> coarse;
  for (int i = 0; i <= 8; ++i) coarse.push_back(std::min(255, 32 * i));
  const auto found = projectorResponse(exact(power(2.2, 0.06), coarse));
  const double error = errorOf(found.curve.light[0], power(2.2, 0.06));
  EXPECT_GT(found.error[0], 0.2 * error);  // it is told that nine levels are few
  EXPECT_LT(found.error[0], 5 * error);
}

void expectRefused(const ResponseSeries& series, const std::string& words) {
  try {
    (void)projectorResponse(series);
    ADD_FAILURE() << "accepted where it should say: " << words;
  } catch (const EstimateError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(ProjectorResponseTest, BadSeriesAreRefused) {
  const ResponseSeries good = exact(power(2.2, 0));
  auto swapped = good;
  std::swap(swapped.levels[1][15].patch, swapped.levels[1][24].patch);
  expectRefused(swapped, "light falls where codes rise, near green level 1");
  auto clipped = good;
  clipped.levels[2][31].patch.clipped = 0.3;
  expectRefused(clipped, "blue level 255 is over-exposed");
  auto cut = good;
  cut.levels[0].pop_back();
  expectRefused(cut, "red needs five levels or more, rising to 255");
  auto dark = good;
  for (auto& level : dark.levels[0]) level.patch = dark.black;
  expectRefused(dark, "full red is no brighter than black");
}

}  // namespace
}  // namespace pixelflex::calib
