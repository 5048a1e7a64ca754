#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "calib/estimate/fiducials.h"
#include "calib/estimate/intrinsics.h"
#include "calib/simulate/aruco_4x4.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::ImageF;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kWhite = 0.8;
constexpr double kBlack = 0.06;

/// A marker of this side (pixels, seen straight on) on a board of its own that is tilted about an axis in the picture
/// and seen by a camera with a focal length of 1500 pixels.
struct Marker {
  int id = 0;
  glm::dvec2 centre{0, 0};
  double side = 40;
  double roll = 0;  // degrees, all
  double tilt = 0;
  double axis = 0;

  /// Board coordinates of a ray, in sides from the centre: the ray's meeting with the tilted plane, by vectors.
  [[nodiscard]] glm::dvec2 boardFromPixel(glm::dvec2 pixel) const {
    constexpr double kFocal = 1500;
    constexpr double kDegree = std::numbers::pi / 180;
    const double c = std::cos(axis * kDegree);
    const double s = std::sin(axis * kDegree);
    const glm::dvec3 along(c, s, 0);
    const glm::dvec3 other(-s * std::cos(tilt * kDegree), c * std::cos(tilt * kDegree), std::sin(tilt * kDegree));
    const glm::dvec3 normal = glm::cross(along, other);
    const glm::dvec3 ray((pixel - centre) / kFocal, 1);
    const glm::dvec3 origin(0, 0, 1);  // of the board, at distance 1
    const glm::dvec3 hit = ray * (glm::dot(normal, origin) / glm::dot(normal, ray)) - origin;
    const glm::dvec2 onBoard = glm::dvec2(glm::dot(hit, along), glm::dot(hit, other)) * kFocal / side;
    const double turned = (roll - axis) * kDegree;
    return {std::cos(turned) * onBoard.x + std::sin(turned) * onBoard.y,
            -std::sin(turned) * onBoard.x + std::cos(turned) * onBoard.y};
  }
};

struct Light {
  double gradient = 3;  // brightest by darkest, left to right
  double vignetting = 0.3;
  double noise = 2;  // codes
  double blur = 0.6;
  unsigned seed = 1;
};

double reflectance(const Marker& marker, glm::dvec2 pixel, double surround) {
  const glm::dvec2 p = marker.boardFromPixel(pixel) + glm::dvec2(0.5);
  if (p.x < -1.0 / 6 || p.y < -1.0 / 6 || p.x > 7.0 / 6 || p.y > 7.0 / 6) return surround;
  if (p.x < 0 || p.y < 0 || p.x >= 1 || p.y >= 1) return kWhite;
  return arucoIsWhite(marker.id, p.x, p.y) ? kWhite : kBlack;
}

/// The point spread and the pixel's area by 64 random rays, the same for every pixel.
std::vector<glm::dvec2> raysWithin(double blur) {
  std::mt19937 random(9);
  std::normal_distribution<double> spread(0, blur);
  std::vector<glm::dvec2> rays;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) rays.emplace_back((x + 0.5) / 8 + spread(random), (y + 0.5) / 8 + spread(random));
  }
  glm::dvec2 mean{0, 0};
  for (const auto& ray : rays) mean += ray / double(rays.size());
  for (auto& ray : rays) ray += glm::dvec2(0.5) - mean;
  return rays;
}

Image8 photograph(devices::Size size, const std::vector<Marker>& markers, const Light& light,
                  double surround = kWhite) {
  ImageF scene(size, 1);
  std::ranges::fill(scene.samples(), static_cast<float>(surround));
  const auto rays = raysWithin(light.blur);
  for (const auto& marker : markers) {
    const double reach = marker.side;
    for (int y = std::max(0, int(marker.centre.y - reach)); y < std::min(size.height, int(marker.centre.y + reach));
         ++y) {
      for (int x = std::max(0, int(marker.centre.x - reach)); x < std::min(size.width, int(marker.centre.x + reach));
           ++x) {
        double sum = 0;
        for (const auto& ray : rays) sum += reflectance(marker, glm::dvec2(x, y) + ray, surround);
        scene.at(x, y) = static_cast<float>(sum / double(rays.size()));
      }
    }
  }
  std::minstd_rand random(light.seed);
  std::normal_distribution<float> noise(0, static_cast<float>(light.noise));
  Image8 photo(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double across = double(x) / size.width;
      const double u = 2 * across - 1;
      const double v = 2.0 * y / size.height - 1;
      const double level =
          240 * (1 / light.gradient + (1 - 1 / light.gradient) * across) * (1 - light.vignetting * (u * u + v * v) / 2);
      for (int c = 0; c < 3; ++c) {
        const double code = level * scene.at(x, y) + noise(random);
        photo.at(x, y, c) = static_cast<std::uint8_t>(std::clamp(std::lround(code), 0L, 255L));
      }
    }
  }
  return photo;
}

/// Six markers at odd places; rolled in all ways.
std::vector<Marker> row(double side, double tilt, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  std::vector<Marker> markers;
  for (int i = 0; i < 6; ++i) {
    markers.push_back({.id = static_cast<int>(any(random) * 8) + 8 * i,
                       .centre = {100 + 150 * i + any(random), 120 + any(random)},
                       .side = side,
                       .roll = 360 * any(random),
                       .tilt = tilt,
                       .axis = 360 * any(random)});
  }
  return markers;
}

struct Score {
  int shown = 0;
  int found = 0;
  int wrong = 0;
  double rms = 0;
};

Score scoreOf(double side, double tilt, const Light& light = {}) {
  Score score;
  double sum = 0;
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const auto markers = row(side, tilt, seed);
    Light own = light;
    own.seed = seed;
    const auto found = findMarkers(photograph({1000, 240}, markers, own), CameraMapping());
    score.shown += static_cast<int>(markers.size());
    for (const auto& [id, centre] : found) {
      const auto marker = std::ranges::find(markers, id, &Marker::id);
      if (marker == markers.end() || glm::length(marker->centre - centre) > 5) {
        ++score.wrong;
        continue;
      }
      ++score.found;
      sum += glm::dot(marker->centre - centre, marker->centre - centre);
    }
  }
  score.rms = std::sqrt(sum / std::max(1, score.found));
  return score;
}

TEST(Markers, SmallAndTiltedOnesAreFoundWellWithinTheirPixel) {
  for (const double tilt : {0., 60.}) {
    const Score small = scoreOf(24, tilt);
    EXPECT_EQ(small.found, small.shown) << tilt;
    EXPECT_EQ(small.wrong, 0) << tilt;
    EXPECT_LT(small.rms, 0.1) << tilt;
    const Score usual = scoreOf(40, tilt);
    EXPECT_EQ(usual.found, usual.shown) << tilt;
    EXPECT_EQ(usual.wrong, 0) << tilt;
    EXPECT_LT(usual.rms, 0.06) << tilt;
  }
}

TEST(Markers, NoiseAndBlurCostAccuracyOnly) {
  const Score noisy = scoreOf(30, 30, {.noise = 8});
  EXPECT_GE(noisy.found, noisy.shown - 1);
  EXPECT_EQ(noisy.wrong, 0);
  EXPECT_LT(noisy.rms, 0.15);
  const Score blurred = scoreOf(36, 30, {.noise = 4, .blur = 1.5});
  EXPECT_GE(blurred.found, blurred.shown - 1);
  EXPECT_EQ(blurred.wrong, 0);
  EXPECT_LT(blurred.rms, 0.15);
}

TEST(Markers, LargeOnesAreNoWorse) {
  const std::vector<Marker> markers = {
      {.id = 7, .centre = {200.3, 180.6}, .side = 210, .roll = 20, .tilt = 30, .axis = 70},
      {.id = 31, .centre = {620.8, 190.1}, .side = 130, .roll = 200, .tilt = 50}};
  const auto found = findMarkers(photograph({800, 400}, markers, {}), CameraMapping());
  ASSERT_EQ(found.size(), 2u);
  for (const auto& marker : markers) EXPECT_LT(glm::length(found.at(marker.id) - marker.centre), 0.1) << marker.id;
}

TEST(Markers, ClutterIsNoMarker) {
  // Squares, grids and letters' strokes of all sizes: hundreds of outlines with four corners.
  Image8 photo({1200, 600}, 3);
  std::mt19937 random(3);
  for (auto& sample : photo.samples()) sample = 190;
  for (int i = 0; i < 400; ++i) {
    const int x0 = static_cast<int>(random() % 1150);
    const int y0 = static_cast<int>(random() % 550);
    const int side = 12 + static_cast<int>(random() % 50);
    const int module = std::max(2, side / 6);
    for (int y = y0; y < std::min(600, y0 + side); ++y) {
      for (int x = x0; x < std::min(1200, x0 + side); ++x) {
        const int cell = (x - x0) / module + 7 * ((y - y0) / module);
        const bool white = ((static_cast<unsigned>(cell + 1) * 2654435761U * static_cast<unsigned>(i + 1)) >> 30) == 1;
        for (int c = 0; c < 3; ++c) photo.at(x, y, c) = white ? 220 : 30;
      }
    }
  }
  EXPECT_THAT(findMarkers(photo, CameraMapping()), ::testing::IsEmpty());
}

TEST(Markers, OneSeenTwiceIsSaidAndOneThatIsNotWantedIgnored) {
  const std::vector<Marker> markers = {
      {.id = 5, .centre = {80, 80}}, {.id = 5, .centre = {300, 90}}, {.id = 9, .centre = {190, 80}}};
  const Image8 photo = photograph({400, 160}, markers, {});
  try {
    (void)findMarkers(photo, CameraMapping(), {5, 9});
    FAIL() << "marker 5 is there twice";
  } catch (const EstimateError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("marker 5 is seen twice"), HasSubstr("(80, 80)"), HasSubstr("(300, 90)")));
  }
  const auto found = findMarkers(photo, CameraMapping(), {9});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found.contains(9));
}

TEST(Markers, LensDistortionIsTakenOut) {
  const CameraMapping camera(CameraIntrinsics{
      .size = {500, 240}, .fx = 400, .fy = 400, .cx = 250, .cy = 120, .radial = {-0.2, 0.05, 0}, .tangential = {}});
  const auto found = findMarkers(photograph({500, 240}, {{.id = 3, .centre = {60, 60}, .side = 30}}, {}), camera);
  ASSERT_EQ(found.size(), 1u);
  // Drawn without the lens's bend, so that its centre in the raw picture is known.
  EXPECT_LT(glm::length(camera.rawFromUndistorted(found.at(3)) - glm::dvec2(60, 60)), 0.2);
}

}  // namespace
}  // namespace pixelflex::calib
