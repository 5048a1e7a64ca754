#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "calib/estimate/camera_response.h"
#include "calib/estimate/exposure_merge.h"
#include "calib/estimate/intrinsics.h"
#include "tests/unit/test_camera.h"

namespace pixelflex::calib {
namespace {

constexpr devices::Size kSize{240, 180};

/// A wall lit unevenly, with a dark border and a lamp: four decades of light.
double scene(int x, int y, int channel) {
  const double u = (x - 100.0) / 120;
  const double v = (y - 80.0) / 120;
  const double wall = 0.6 * std::exp(-1.2 * (u * u + v * v)) * (1 + 0.1 * channel);
  const bool shadow = x > 200 || y > 150;
  return shadow ? 0.02 * wall : wall;
}

std::vector<ExposedPhoto> series(const TestCamera& camera, int count, double shortest = 1.0 / 16, double step = 2) {
  std::mt19937 random(3);
  std::vector<ExposedPhoto> photos;
  for (int i = 0; i < count; ++i) photos.push_back(camera.shoot(kSize, shortest * std::pow(step, i), scene, random));
  return photos;
}

struct Error {
  double rms = 0;
  double most = 0;
};

/// Relative error over codes 20 to 235 with the scale that fits best.
Error errorOf(const std::array<double, 256>& light, const TestCamera& camera) {
  std::vector<double> logs;
  for (std::size_t code = 20; code <= 235; ++code) {
    logs.push_back(std::log(light.at(code) / lightOfCode(camera, double(code))));
  }
  double mean = 0;
  for (const double value : logs) mean += value / double(logs.size());
  Error error;
  for (const double value : logs) {
    error.rms += std::pow(value - mean, 2) / double(logs.size());
    error.most = std::max(error.most, std::abs(value - mean));
  }
  error.rms = std::sqrt(error.rms);
  return error;
}

void expectRecovered(const TestCamera& camera, double rms, double most) {
  const auto found = estimateCameraResponse(series(camera, 8));
  for (const auto& light : found.light) {
    const Error error = errorOf(light, camera);
    EXPECT_LT(error.rms, rms);
    EXPECT_LT(error.most, most);
    EXPECT_TRUE(std::ranges::is_sorted(light));
    EXPECT_EQ(light.front(), 0);
    EXPECT_EQ(light.back(), 1);
  }
  EXPECT_GT(found.error, 0);
  EXPECT_LT(found.error, rms);
  EXPECT_LT(found.residual, 0.02);
}

TEST(CameraResponseTest, SrgbWithABend) {
  expectRecovered({bentFromLight}, 0.004, 0.015);
}

TEST(CameraResponseTest, Srgb) {
  expectRecovered({srgbFromLight}, 0.004, 0.015);
}

TEST(CameraResponseTest, ALinearCameraComesOutLinear) {
  expectRecovered({[](double light) { return light; }}, 0.004, 0.015);
}

TEST(CameraResponseTest, PowerLaws) {
  for (const double gamma : {1.8, 2.2}) {
    expectRecovered({[=](double light) { return std::pow(light, 1 / gamma); }}, 0.004, 0.015);
  }
}

TEST(CameraResponseTest, OrderOfTheSeriesDoesNotMatter) {
  auto photos = series({srgbFromLight}, 5, 1.0 / 8, 3);
  const auto found = estimateCameraResponse(photos);
  std::ranges::rotate(photos, photos.begin() + 2);
  std::swap(photos[0], photos[3]);
  EXPECT_EQ(estimateCameraResponse(photos).light, found.light);
}

void expectRefused(const std::vector<ExposedPhoto>& photos, const std::string& words) {
  try {
    (void)estimateCameraResponse(photos);
    ADD_FAILURE() << "accepted where it should say: " << words;
  } catch (const EstimateError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(CameraResponseTest, BadSeriesAreRefused) {
  const TestCamera camera{srgbFromLight};
  auto photos = series(camera, 8);
  expectRefused({photos[0], photos[5]}, "three photographs or more");
  expectRefused({photos[3], photos[3], photos[3]}, "too much alike");
  auto fixed = photos;
  for (auto& one : fixed) one.photo = photos[4].photo;
  expectRefused(fixed, "is not brighter than the one with 0.0625");
  auto swapped = photos;
  std::swap(swapped[3].photo, swapped[4].photo);
  expectRefused(swapped, "exposure 1 is not brighter than the one with 0.5");
  auto negative = photos;
  negative[0].exposure = -1;
  expectRefused(negative, "positive number, found -1");
  auto small = photos;
  small[2].photo = devices::Image8({80, 60}, 3);
  expectRefused(small, "of one size");
  expectRefused(series(camera, 4, 1e-6), "between codes 20 and 235");
  expectRefused(series(camera, 4, 1e6), "between codes 20 and 235");
}

TEST(CameraResponseTest, LightThatChangesIsRefused) {
  auto photos = series({srgbFromLight}, 8);
  for (auto& one : photos) one.exposure = std::pow(one.exposure, one.exposure < 1 ? 1.6 : 0.7);
  std::mt19937 random(1);
  for (std::size_t i = 0; i < photos.size(); i += 2) {  // every second with half the light
    photos[i] = TestCamera{srgbFromLight}.shoot(
        kSize, photos[i].exposure, [](int x, int y, int c) { return (x < 120 ? 0.55 : 1.0) * scene(x, y, c); }, random);
  }
  EXPECT_THROW((void)estimateCameraResponse(photos), EstimateError);
}

TEST(ExposureMerge, IsLinearOverFourDecades) {
  const TestCamera camera{srgbFromLight};
  CameraResponse known;
  for (auto& light : known.light) {
    for (std::size_t code = 0; code < 256; ++code) light.at(code) = lightOfCode(camera, double(code));
  }
  const auto merged = mergeExposures(series(camera, 8), known);
  for (const auto& [x, y] : {std::pair(20, 20), std::pair(100, 80), std::pair(180, 130), std::pair(230, 170)}) {
    for (int c = 0; c < 3; ++c) {
      double measured = 0;
      double truth = 0;
      for (int j = -3; j <= 3; ++j) {
        for (int i = -3; i <= 3; ++i) {
          measured += merged.at(x + i, y + j, c);
          truth += scene(x + i, y + j, c);
        }
      }
      EXPECT_NEAR(measured / truth, 1, x > 200 ? 0.03 : 0.005);  // in the shadow few electrons tell
    }
  }
}

TEST(ExposureMerge, OutOfRangeTheBestPhotographTells) {
  const auto photo = [](double exposure, std::uint8_t code) {
    ExposedPhoto one{exposure, devices::Image8({4, 4}, 3)};
    std::ranges::fill(one.photo.samples(), code);
    return one;
  };
  const auto merged = [&](std::vector<ExposedPhoto> photos) { return mergeExposures(photos, linearCamera()).at(1, 1); };
  EXPECT_NEAR(merged({photo(1, 4), photo(4, 16)}), 4 / 255.0, 1e-6);       // both dark: the longer
  EXPECT_NEAR(merged({photo(1, 240), photo(4, 255)}), 240 / 255.0, 1e-6);  // both bright: the shorter
  EXPECT_NEAR(merged({photo(1, 10), photo(30, 255)}), 10 / 255.0, 1e-6);
  EXPECT_NEAR(patchLight(std::vector{photo(1, 255), photo(4, 255)}, linearCamera()).clipped, 1, 1e-9);
  const auto patch = patchLight(std::vector{photo(1, 100), photo(2, 200)}, linearCamera());
  EXPECT_NEAR(patch.light[2], 100 / 255.0, 1e-6);
  EXPECT_NEAR(patch.deviation[2], 0.29 / 255 / 2, 1e-4);  // one code all over: rounding may have hidden a part of it
  EXPECT_EQ(patch.clipped, 0);
}

}  // namespace
}  // namespace pixelflex::calib
