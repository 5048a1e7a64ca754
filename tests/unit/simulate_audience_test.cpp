#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "calib/simulate/hand_aimed.h"
#include "calib/simulate/rig_generator.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::Size;

double linearOf(int code) {
  const double value = code / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

Image8 plain(Size size, std::uint8_t code) {
  Image8 image(size, 1);
  std::ranges::fill(image.samples(), code);
  return image;
}

/// A small wall without markers, ambient light or leak.
Rig bareRig() {
  Rig rig = miniRig(2);
  rig.markers.clear();
  rig.room.dark = 0;
  for (auto& projector : rig.projectors) projector.response.black = 0;
  return rig;
}

TEST(SimulateAudience, ShowsTheLightThatTheGroundTruthGives) {
  const SimulatedWall wall(bareRig());
  const Size frame = wall.rig().projectors[0].resolution;
  const Image8 picture =
      wall.audience({plain(frame, 200), plain(frame, 120)}, {0, 0}, wall.rig().screenSize, {1000, 660}, 1.5);
  int checked = 0;
  for (int y = 5; y < 660; y += 23) {
    for (int x = 5; x < 1000; x += 23) {
      const glm::dvec2 point = glm::dvec2(x + 0.5, y + 0.5) / glm::dvec2(1000, 660) * wall.rig().screenSize;
      double expected = 0;
      bool nearEdge = false;
      for (std::size_t i = 0; i < 2; ++i) {
        const glm::dvec2 pixel = wall.projectorFromWall(i, point).value();
        const glm::dvec2 inside = glm::min(pixel, glm::dvec2(frame.width, frame.height) - pixel);
        const double depth = std::min(inside.x, inside.y);
        nearEdge = nearEdge || std::abs(depth) < 4;
        if (depth > 0) expected += wall.radiance(i, pixel) * wall.light(i, 1, (i == 0 ? 200 : 120) / 255.0);
      }
      if (nearEdge) continue;
      const double tolerance = 0.004 + 0.006 * expected;  // a rounded sRGB code
      EXPECT_NEAR(linearOf(picture.at(x, y, 1)), std::min(1.0, expected / 1.5), tolerance) << x << ", " << y;
      checked += expected > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(checked, 200);
}

TEST(SimulateAudience, MeasuresTheLightOfEveryChannelExactly) {
  Rig rig = miniRig(3);  // with markers, ambient light and leak: only the last may count
  const SimulatedWall wall(rig);
  const Size frame = rig.projectors[0].resolution;
  const std::vector<Image8> frames{plain(frame, 12), {}};
  const Size size{1000, 660};
  const devices::ImageF light = wall.audienceLight(frames, {0, 0}, rig.screenSize, size);
  EXPECT_EQ(wall.audienceLight(frames, {0, 0}, rig.screenSize, size), light);
  int checked = 0;
  for (int y = 5; y < size.height; y += 23) {
    for (int x = 5; x < size.width; x += 23) {
      const glm::dvec2 point = glm::dvec2(x + 0.5, y + 0.5) / glm::dvec2(size.width, size.height) * rig.screenSize;
      std::array<double, 3> expected{};
      bool nearEdge = false;
      for (std::size_t i = 0; i < 2; ++i) {
        const glm::dvec2 pixel = wall.projectorFromWall(i, point).value();
        const glm::dvec2 inside = glm::min(pixel, glm::dvec2(frame.width, frame.height) - pixel);
        const double depth = std::min(inside.x, inside.y);
        nearEdge = nearEdge || std::abs(depth) < 4;
        for (int c = 0; depth > 0 && c < 3; ++c) {
          expected.at(static_cast<std::size_t>(c)) +=
              wall.radiance(i, pixel) * wall.light(i, c, i == 0 ? 12 / 255.0 : 0);
        }
      }
      for (int c = 0; !nearEdge && c < 3; ++c) {
        const double e = expected.at(static_cast<std::size_t>(c));
        EXPECT_NEAR(light.at(x, y, c), e, 1e-3 * e) << x << ", " << y;
        checked += e > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(checked, 600);
}

TEST(SimulateAudience, PutsAPixelInItsPlace) {
  const SimulatedWall wall(bareRig());
  const Size frame = wall.rig().projectors[1].resolution;
  Image8 spot(frame, 3);
  for (int y = 300; y < 304; ++y) {
    for (int x = 400; x < 404; ++x) spot.at(x, y, 1) = 255;
  }
  const Size size{1600, 1056};
  const Image8 picture = wall.audience({{}, spot}, {0, 0}, wall.rig().screenSize, size);
  double sum = 0;
  glm::dvec2 middle(0);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double light = linearOf(picture.at(x, y, 1));
      sum += light;
      middle += light * glm::dvec2(x + 0.5, y + 0.5);
      EXPECT_EQ(picture.at(x, y, 0), 0);
    }
  }
  const glm::dvec2 expected =
      wall.wallFromProjector(1, {402, 302}).value() / wall.rig().screenSize * glm::dvec2(size.width, size.height);
  EXPECT_LT(glm::distance(middle / sum, expected), 0.03);
}

TEST(SimulateAudience, BlackProjectorsLeak) {
  Rig rig = bareRig();
  rig.projectors[0].response.black = 0.01;
  const SimulatedWall wall(rig);
  const Image8 picture = wall.audience({}, {0, 0}, rig.screenSize, {300, 200}, 0.05);
  const glm::dvec2 lit = wall.wallFromProjector(0, {200, 240}).value() / rig.screenSize * glm::dvec2(300, 200);
  const double expected = wall.radiance(0, {200, 240}) * wall.light(0, 1, 0) / 0.05;
  EXPECT_NEAR(linearOf(picture.at(static_cast<int>(lit.x), static_cast<int>(lit.y), 1)), expected, 0.01);
  EXPECT_EQ(picture.at(2, 2, 1), 0);
}

TEST(SimulateHandAimed, CutsTheDesktopWhereTheProjectorsPoint) {
  const SimulatedWall wall(bareRig());
  const WallRect rect = litRect(wall);
  const glm::dvec2 extent = rect.bottomRight - rect.topLeft;
  Image8 desktop({1000, 400}, 3);
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 1000; ++x) {
      desktop.at(x, y, 0) = static_cast<std::uint8_t>(x / 4);
      desktop.at(x, y, 1) = static_cast<std::uint8_t>(y / 2);
    }
  }
  const auto frames = handAimedFrames(wall, desktop, rect);
  ASSERT_EQ(frames.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(frames[i].size(), (Size{640, 480}));
    // In the middle of a frame the nominal share is right to a few centimetres; the corners show keystone.
    const glm::dvec2 part = (wall.wallFromProjector(i, {320, 240}).value() - rect.topLeft) / extent;
    EXPECT_NEAR(frames[i].at(320, 240, 0), 250 * part.x, 6);
    EXPECT_NEAR(frames[i].at(320, 240, 1), 200 * part.y, 6);
  }
}

TEST(SimulateHandAimed, IsBlackBeyondTheDesktop) {
  const SimulatedWall wall(bareRig());
  const glm::dvec2 middle = 0.5 * wall.rig().screenSize;
  const auto frames = handAimedFrames(wall, plain({50, 50}, 255), {middle - 200.0, middle + 200.0});
  EXPECT_EQ(frames[0].at(2, 2, 0), 0);
  EXPECT_EQ(*std::ranges::max_element(frames[0].samples()), 255);
}

}  // namespace
}  // namespace pixelflex::calib
