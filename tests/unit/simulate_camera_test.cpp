#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "calib/simulate/rig_generator.h"
#include "calib/simulate/sensor.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::ImageF;
using devices::Scene;
using devices::Size;

Image8 plain(Size size, std::uint8_t code) {
  Image8 image(size, 1);
  std::ranges::fill(image.samples(), code);
  return image;
}

Rig quietRig() {
  Rig rig = miniRig(2);
  rig.camera.readNoise = 0;
  rig.camera.fullWell = 1e7;
  return rig;
}

ImageF evenLight(Size size, float level) {
  ImageF image(size, 3);
  std::ranges::fill(image.samples(), level);
  return image;
}

struct Moments {
  double mean = 0;
  double deviation = 0;
};

Moments momentsOf(const Image8& photo) {
  double sum = 0;
  double squares = 0;
  for (const double code : photo.samples()) {
    sum += code;
    squares += code * code;
  }
  const auto count = static_cast<double>(photo.samples().size());
  return {sum / count, std::sqrt(squares / count - sum * sum / count / count)};
}

TEST(SimulateSensor, NoiseHasTheExpectedMeanAndDeviation) {
  SimulatedCameraSpec camera;
  camera.fullWell = 2000;
  camera.readNoise = 20;
  for (const double level : {0.1, 0.3, 0.6, 0.8}) {
    const auto moments = momentsOf(expose(camera, evenLight({500, 400}, static_cast<float>(level)), 1, 7));
    const double electrons = level * camera.fullWell;
    const double deviation = 255 / camera.fullWell * std::sqrt(electrons + 400.0);
    EXPECT_NEAR(moments.mean, 255 * level, 0.02);
    EXPECT_NEAR(moments.deviation, std::sqrt(deviation * deviation + 1.0 / 12), 0.015 * deviation);
  }
}

TEST(SimulateSensor, ClipsAndCurves) {
  SimulatedCameraSpec camera;
  camera.readNoise = 0;
  camera.fullWell = 1e7;
  EXPECT_EQ(momentsOf(expose(camera, evenLight({80, 80}, 3), 1, 1)).mean, 255);
  camera.gamma = 2.2;
  EXPECT_NEAR(momentsOf(expose(camera, evenLight({80, 80}, 0.2F), 1, 1)).mean, 255 * std::pow(0.2, 1 / 2.2), 0.51);
}

TEST(SimulateSensor, SeedDecidesTheNoise) {
  const SimulatedCameraSpec camera;
  const ImageF light = evenLight({200, 150}, 0.5F);
  EXPECT_EQ(expose(camera, light, 1, 3), expose(camera, light, 1, 3));
  EXPECT_NE(expose(camera, light, 1, 3), expose(camera, light, 1, 4));
}

TEST(SimulateCamera, SameSeedTakesTheSamePhotographs) {
  SimulatedWall first(miniRig(2));
  SimulatedWall second(miniRig(2));
  const Image8 photo = first.camera().shoot();
  EXPECT_EQ(photo.size(), (Size{960, 600}));
  EXPECT_EQ(photo.channels(), 3);
  EXPECT_EQ(photo, second.camera().shoot());
  EXPECT_NE(photo, first.camera().shoot());  // new noise in every photograph
}

TEST(SimulateCamera, LightOfTwoProjectorsAdds) {
  SimulatedWall wall(quietRig());
  const Size size = wall.projector(0).resolution();
  const auto photograph = [&](std::uint8_t first, std::uint8_t second) {
    wall.projector(0).show(plain(size, first));
    wall.projector(1).show(plain(size, second));
    return wall.camera().shoot();
  };
  const Image8 dark = photograph(0, 0);
  const Image8 left = photograph(150, 0);
  const Image8 right = photograph(0, 160);
  const Image8 both = photograph(150, 160);
  int overlapping = 0;
  for (std::size_t i = 0; i < dark.samples().size(); ++i) {
    const int a = left.samples()[i] - dark.samples()[i];
    const int b = right.samples()[i] - dark.samples()[i];
    overlapping += a > 20 && b > 20 ? 1 : 0;
    ASSERT_NEAR(both.samples()[i] - dark.samples()[i], a + b, 3);  // four roundings to whole codes
  }
  EXPECT_GT(overlapping, 10000);
}

TEST(SimulateCamera, BlankIsBlack) {
  Rig rig = quietRig();
  SimulatedWall wall(rig);
  const Image8 dark = wall.camera().shoot();
  wall.projector(0).show(plain(wall.projector(0).resolution(), 200));
  EXPECT_GT(momentsOf(wall.camera().shoot()).mean, momentsOf(dark).mean + 5);
  wall.projector(0).blank();
  EXPECT_NEAR(momentsOf(wall.camera().shoot()).mean, momentsOf(dark).mean, 0.01);
}

TEST(SimulateCamera, ExposureSuitsTheScene) {
  SimulatedWall wall(quietRig());
  int brightest = 0;
  for (std::size_t i = 0; i < wall.projectorCount(); ++i) {
    wall.projector(i).show(plain(wall.projector(i).resolution(), 255));
    const Image8 photo = wall.camera().shoot();
    brightest = std::max<int>(brightest, *std::ranges::max_element(photo.samples()));
    wall.projector(i).blank();
  }
  EXPECT_NEAR(brightest, 0.85 * 255, 3);
  ASSERT_TRUE(wall.person().arrange(Scene::kRoomLight, 0));
  const Image8 room = wall.camera().shoot();
  EXPECT_NEAR(room.at(480, 300, 1), 0.75 * 255, 25);
  EXPECT_LT(*std::ranges::max_element(room.samples()), 250);
}

/// Where one projector pixel appears, how much light it brings and how far it spreads along x, around its middle.
TEST(SimulateCamera, SpotLandsWhereTheRaysSayWithThePointSpread) {
  Rig rig = quietRig();
  rig.camera.blur = 1.2;
  rig.room.dark = 0;
  rig.projectors.resize(1);
  auto& spec = rig.projectors[0];
  spec.response = {.gamma = {1, 1, 1}, .gain = {1, 1, 1}, .toe = 0, .black = 0};
  SimulatedWall wall(rig);
  Image8 frame(spec.resolution, 1);
  constexpr int kSide = 3;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) frame.at(250 + x, 200 + y) = 255;
  }
  wall.projector(0).show(frame);
  const Image8 photo = wall.camera().shoot();
  double sum = 0;
  glm::dvec2 middle(0);
  double square = 0;
  for (int y = 0; y < photo.height(); ++y) {
    for (int x = 0; x < photo.width(); ++x) {
      const double light = photo.at(x, y, 1);
      sum += light;
      middle += light * glm::dvec2(x + 0.5, y + 0.5);
      square += light * (x + 0.5) * (x + 0.5);
    }
  }
  middle /= sum;
  const auto cameraAt = [&](double x, double y) {
    return wall.cameraFromWall(wall.wallFromProjector(0, {x, y}).value()).value();
  };
  EXPECT_LT(glm::distance(middle, cameraAt(251.5, 201.5)), 0.05);
  const double scale = glm::distance(cameraAt(251, 201.5), cameraAt(252, 201.5));  // camera per projector pixel
  const double spot = (kSide * kSide / 12.0 + spec.defocus * spec.defocus) * scale * scale;
  const double expected = spot + 1.2 * 1.2 + 1.0 / 12;  // the spot, the point spread and the camera's own pixel
  EXPECT_NEAR(square / sum - middle.x * middle.x, expected, 0.12 * expected);
}

TEST(SimulateCamera, SumOfLightDoesNotDependOnTheFocus) {
  std::array<double, 2> sums{};
  for (std::size_t i = 0; i < 2; ++i) {
    Rig rig = quietRig();
    rig.projectors[0].defocus = i == 0 ? 0.3 : 2.0;
    SimulatedWall wall(rig);
    Image8 frame(rig.projectors[0].resolution, 1);
    for (int y = 100; y < 200; ++y) {
      for (int x = 100; x < 200; ++x) frame.at(x, y) = 230;
    }
    const double dark = momentsOf(wall.camera().shoot()).mean;
    wall.projector(0).show(frame);
    sums.at(i) = momentsOf(wall.camera().shoot()).mean - dark;
  }
  EXPECT_NEAR(sums[0], sums[1], 0.01 * sums[0]);
}

}  // namespace
}  // namespace pixelflex::calib
