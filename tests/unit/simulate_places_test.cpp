#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "calib/simulate/rig_generator.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::Size;

/// One place for everything, one from the left, and one so close to the right end that p1 is out of the picture.
Rig quietRig() {
  Rig rig = miniRig(2);
  rig.camera.readNoise = 0;
  rig.camera.fullWell = 1e7;
  const glm::dvec3 position = rig.camera.pose.position;
  rig.cameraPlaces.push_back({position - glm::dvec3(700, 0, 0), {15, -5, 1}});
  rig.cameraPlaces.push_back({{2300, 800, -700}, {0, 0, 0}});
  return rig;
}

/// White pixels up to `reach` to every side of a point.
Image8 spotAt(Size size, int x, int y, int reach) {
  Image8 image(size, 1);
  for (int row = y - reach; row < y + reach; ++row) {
    for (int column = x - reach; column < x + reach; ++column) image.at(column, row) = 255;
  }
  return image;
}

/// Of what a photograph shows more of than another one.
glm::dvec2 centroid(const Image8& lit, const Image8& dark) {
  double sum = 0;
  glm::dvec2 middle(0);
  for (int y = 0; y < lit.height(); ++y) {
    for (int x = 0; x < lit.width(); ++x) {
      const double light = std::max(0, lit.at(x, y, 1) - dark.at(x, y, 1) - 1);
      sum += light;
      middle += light * glm::dvec2(x + 0.5, y + 0.5);
    }
  }
  return middle / sum;
}

TEST(SimulatePlaces, ThePersonGoesWhereTheRigSays) {
  SimulatedWall wall(quietRig());
  EXPECT_EQ(wall.placeCount(), 3);
  EXPECT_TRUE(wall.person().placeCamera(2));
  EXPECT_TRUE(wall.person().placeCamera(0));
  EXPECT_FALSE(wall.person().placeCamera(3));
  EXPECT_FALSE(wall.person().placeCamera(-1));
  SimulatedWall usual(miniRig(2));
  EXPECT_EQ(usual.placeCount(), 1);
  EXPECT_TRUE(usual.person().placeCamera(0));
  EXPECT_FALSE(usual.person().placeCamera(1));
}

TEST(SimulatePlaces, PhotographsShowTheWallFromThere) {
  SimulatedWall wall(quietRig());
  const Size size = wall.projector(1).resolution();
  const glm::dvec2 pointInWall = wall.wallFromProjector(1, {500, 300}).value();
  glm::dvec2 before(-1e3);
  for (const int place : {0, 1, 2}) {
    ASSERT_TRUE(wall.person().placeCamera(place));
    wall.projector(1).blank();
    const Image8 dark = wall.camera().shoot();
    wall.projector(1).show(spotAt(size, 500, 300, 4));
    const glm::dvec2 seen = centroid(wall.camera().shoot(), dark);
    EXPECT_LT(glm::distance(seen, wall.cameraFromWall(pointInWall, place).value()), 0.05) << "place " << place;
    EXPECT_GT(glm::distance(seen, before), 20);
    before = seen;
  }
}

TEST(SimulatePlaces, WhatIsShownStaysWhenTheCameraMoves) {
  SimulatedWall moved(quietRig());
  SimulatedWall still(quietRig());
  for (SimulatedWall* wall : {&moved, &still}) {
    wall->projector(0).show(spotAt(wall->projector(0).resolution(), 200, 200, 4));
    ASSERT_TRUE(wall->person().arrange(devices::Scene::kRoomLight, 0));
    (void)wall->camera().shoot();
  }
  ASSERT_TRUE(moved.person().placeCamera(1));
  ASSERT_TRUE(moved.person().placeCamera(0));
  EXPECT_EQ(moved.camera().shoot(), still.camera().shoot());
}

TEST(SimulatePlaces, AProjectorOutsideThePictureIsNotSeen) {
  SimulatedWall wall(quietRig());
  ASSERT_TRUE(wall.person().placeCamera(2));
  const Image8 dark = wall.camera().shoot();
  Image8 white(wall.projector(0).resolution(), 1);
  std::ranges::fill(white.samples(), std::uint8_t{255});
  wall.projector(0).show(white);
  const Image8 photo = wall.camera().shoot();
  for (std::size_t i = 0; i < dark.samples().size(); ++i) {
    ASSERT_NEAR(photo.samples()[i], dark.samples()[i], 1);
  }
  wall.projector(1).show(white);  // reaches beyond the picture
  const Image8 part = wall.camera().shoot();
  EXPECT_GT(*std::ranges::max_element(part.samples()), 150);
}

TEST(SimulatePlaces, ACurvedScreenIsPhotographedWhereTheGeometrySays) {
  Rig rig = cylinderRig(2);
  rig.camera.size = {960, 540};  // quicker
  rig.camera.optics.focal /= 2;
  rig.camera.optics.principal /= 2;
  rig.camera.readNoise = 0;
  rig.camera.fullWell = 1e7;
  SimulatedWall wall(rig);
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}}) {
    const Image8 dark = wall.camera().shoot();
    const glm::dvec2 pointInWall = wall.wallFromProjector(i, {400, 800}).value();
    wall.projector(i).show(spotAt(wall.projector(i).resolution(), 400, 800, 8));
    const glm::dvec2 seen = centroid(wall.camera().shoot(), dark);
    EXPECT_LT(glm::distance(seen, wall.cameraFromWall(pointInWall).value()), 0.05);
    wall.projector(i).blank();
  }
}

}  // namespace
}  // namespace pixelflex::calib
