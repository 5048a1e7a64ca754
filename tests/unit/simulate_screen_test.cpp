#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "calib/simulate/cylindrical_screen.h"
#include "calib/simulate/projector_light.h"
#include "calib/simulate/rig_generator.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {
namespace {

using std::numbers::pi;

/// Hollow: the axis is at x = 1000, z = -3000.
CylindricalScreen hollow() {
  return {3000, 1000};
}

/// Bulging: the axis is at x = 0, z = 2000.
CylindricalScreen bulging() {
  return {-2000, 0};
}

void expectNear(glm::dvec3 point, glm::dvec3 expected, double tolerance = 1e-9) {
  EXPECT_NEAR(point.x, expected.x, tolerance);
  EXPECT_NEAR(point.y, expected.y, tolerance);
  EXPECT_NEAR(point.z, expected.z, tolerance);
}

TEST(SimulateCylinder, HollowScreenIsMetFromInside) {
  // From the axis, 30 degrees to the right.
  const auto right = hollow().hit({1000, 50, -3000}, {0.5, 0, std::sqrt(0.75)});
  ASSERT_TRUE(right);
  expectNear(*right, {2500, 50, -3000 + 1500 * std::sqrt(3.0)});
  EXPECT_NEAR(hollow().wallFromRoom(*right).x, 1000 + 500 * pi, 1e-9);
  EXPECT_NEAR(hollow().wallFromRoom(*right).y, 50, 1e-9);
  // Straight ahead, 1800 off the axis: 1800, 2400 and 3000 make a right triangle.
  const auto ahead = hollow().hit({-800, 0, -5000}, {0, 0.1, 2});
  ASSERT_TRUE(ahead);
  expectNear(*ahead, {-800, 220, -600});
  EXPECT_NEAR(hollow().wallFromRoom(*ahead).x, 1000 - 3000 * std::asin(0.6), 1e-9);
}

TEST(SimulateCylinder, HollowScreenIsMetFromFarAway) {
  const auto apex = hollow().hit({1000, 0, -9000}, {0, 0.1, 1});  // enters the cylinder where there is no screen
  ASSERT_TRUE(apex);
  expectNear(*apex, {1000, 900, 0});
  EXPECT_NEAR(hollow().wallFromRoom(*apex).x, 1000, 1e-9);
}

TEST(SimulateCylinder, BulgingScreenIsMetFromOutside) {
  const auto side = bulging().hit({1200, -30, -4000}, {0, 0, 1});
  ASSERT_TRUE(side);
  expectNear(*side, {1200, -30, 400});
  EXPECT_NEAR(bulging().wallFromRoom(*side).x, 2000 * std::asin(0.6), 1e-9);
  EXPECT_FALSE(bulging().hit({2100, 0, -4000}, {0, 0, 1}));   // past it
  EXPECT_FALSE(bulging().hit({1200, 0, -4000}, {0, 0, -1}));  // away from it
  EXPECT_FALSE(bulging().hit({0, 0, 2000}, {0, 0, -1}));      // from inside: its back
}

TEST(SimulateCylinder, EndsEightyDegreesFromItsMiddle) {
  const auto towards = [](double degrees) {
    return glm::dvec3(std::sin(glm::radians(degrees)), 0, std::cos(glm::radians(degrees)));
  };
  const glm::dvec3 axis(1000, 0, -3000);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_TRUE(hollow().hit(axis, towards(79.9 * side)));
    EXPECT_FALSE(hollow().hit(axis, towards(80.1 * side)));
    EXPECT_TRUE(hollow().isVisible(axis, {1000 + side * 3000 * glm::radians(79.9), 0}));
    EXPECT_FALSE(hollow().isVisible(axis, {1000 + side * 3000 * glm::radians(80.1), 0}));
  }
}

TEST(SimulateCylinder, HidesWhatIsBehindIt) {
  EXPECT_FALSE(hollow().hit({1000, 0, 500}, {0, 0, -1}));
  EXPECT_FALSE(hollow().isVisible({1000, 0, 500}, {1000, 0}));
  // From behind the left end, 70 degrees round: the screen's back is in the way of its right half.
  const glm::dvec3 behind(-2500, 0, -2000);
  EXPECT_FALSE(hollow().hit(behind, {1, 0, 0}));
  EXPECT_FALSE(hollow().isVisible(behind, {1000 + 3000 * glm::radians(60.0), 0}));
  // The far side of a pillar.
  EXPECT_TRUE(bulging().isVisible({0, 0, -2000}, {2000 * glm::radians(59.0), 0}));
  EXPECT_FALSE(bulging().isVisible({0, 0, -2000}, {2000 * glm::radians(61.0), 0}));
}

TEST(SimulateCylinder, UnrollsWithoutStretching) {
  for (const CylindricalScreen& screen : {hollow(), bulging()}) {
    for (double x = -1500; x <= 1500; x += 125) {
      const glm::dvec3 point = screen.roomFromWall({x, 70});
      EXPECT_NEAR(screen.wallFromRoom(point).x, x, 1e-9);
      EXPECT_NEAR(screen.wallFromRoom(point).y, 70, 1e-9);
      const glm::dvec3 along = screen.roomFromWall({x + 0.5, 70}) - screen.roomFromWall({x - 0.5, 70});
      EXPECT_NEAR(glm::length(along), 1, 1e-7);
      const glm::dvec3 normal = screen.normal({x, 70});
      EXPECT_NEAR(glm::length(normal), 1, 1e-12);
      EXPECT_NEAR(glm::dot(normal, along), 0, 1e-9);
      EXPECT_LT(normal.z, 0);
    }
  }
}

TEST(SimulateCylinder, FlatterAndFlatterBecomesThePlane) {
  const CylindricalScreen screen(1e9, 500);
  const auto point = screen.hit({700, 100, -2000}, {0.3, -0.2, 1});
  ASSERT_TRUE(point);
  expectNear(*point, {1300, -300, 0}, 1e-3);
  EXPECT_NEAR(screen.wallFromRoom(*point).x, 1300, 1e-3);
}

TEST(SimulateCylinder, LightSpreadsOverTheCurvedScreen) {
  SimulatedProjectorSpec spec;
  spec.resolution = {1000, 600};
  spec.optics.focal = 1500;
  spec.optics.principal = {500, 300};
  spec.pose.position = {1000, 0, -3000};  // on the axis
  spec.vignetting = 0;
  const CylindricalScreen screen = hollow();
  const ProjectorLight light(spec, screen);
  for (const double u : {-450.0, -100.0, 0.0, 300.0}) {
    for (const double v : {-250.0, 0.0, 120.0}) {
      // From the axis, a pixel (u, v) off the middle lies at the angle atan(u / f), at the height R v / sqrt(u^2 +
      // f^2).
      const double ray = std::hypot(u, 1500.0);
      const auto wall = light.wallFromPixel({500 + u, 300 + v});
      ASSERT_TRUE(wall);
      EXPECT_NEAR(wall->x, 1000 + 3000 * std::atan(u / 1500), 1e-9);
      EXPECT_NEAR(wall->y, 3000 * v / ray, 1e-9);
      const double area = 3000.0 * 3000.0 * 1500 / (ray * ray * ray);
      EXPECT_NEAR(light.illuminance(*wall) * area * 600000 / spec.lumens, 1, 1e-6);
    }
  }
}

TEST(SimulateCylinder, PixelToWallToPixelIsTheSame) {
  for (const double radius : {3000.0, -4000.0}) {
    Rig rig = cylinderRig(3);
    rig.screenRadius = radius;
    const SimulatedWall wall(rig);
    for (std::size_t i = 0; i < wall.projectorCount(); ++i) {
      for (int k = 0; k < 99; ++k) {
        const glm::dvec2 pixel(192 * (k % 11), 135 * (k / 11));
        const auto onWall = wall.wallFromProjector(i, pixel);
        if (radius < 0 && !onWall) continue;  // aimed for the hollow screen, some pass by the bulging one
        ASSERT_TRUE(onWall);
        const auto back = wall.projectorFromWall(i, *onWall);
        ASSERT_TRUE(back);
        EXPECT_LT(glm::distance(*back, pixel), 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace pixelflex::calib
