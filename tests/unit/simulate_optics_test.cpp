#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "calib/simulate/lens.h"
#include "calib/simulate/placed_optics.h"
#include "calib/simulate/planar_screen.h"
#include "calib/simulate/rig_generator.h"

namespace pixelflex::calib {
namespace {

Optics obliqueLens() {
  Optics optics;
  optics.focal = 1500;
  optics.principal = {520, 610};
  optics.radial = {-0.12, 0.04, -0.01};
  optics.tangential = {0.002, -0.003};
  return optics;
}

/// Brown's formula written out term by term from the textbook, with powers instead of Horner's scheme.
std::array<long double, 2> textbookPixel(const Optics& optics, long double x, long double y) {
  const long double r = std::sqrt(x * x + y * y);
  const long double radial = 1 + optics.radial[0] * std::pow(r, 2.0L) + optics.radial[1] * std::pow(r, 4.0L) +
                             optics.radial[2] * std::pow(r, 6.0L);
  const long double dx = 2 * optics.tangential[0] * x * y + optics.tangential[1] * (r * r + 2 * x * x);
  const long double dy = optics.tangential[0] * (r * r + 2 * y * y) + 2 * optics.tangential[1] * x * y;
  return {optics.focal * (x * radial + dx) + optics.principal.x, optics.focal * (y * radial + dy) + optics.principal.y};
}

TEST(SimulateLens, FollowsTheTextbook) {
  const Optics optics = obliqueLens();
  const Lens lens(optics);
  for (double x = -0.6; x <= 0.6; x += 0.15) {
    for (double y = -0.5; y <= 0.5; y += 0.125) {
      const auto pixel = lens.pixelFromRay({x, y});
      const auto expected = textbookPixel(optics, x, y);
      ASSERT_TRUE(pixel);
      EXPECT_NEAR(pixel->x, static_cast<double>(expected[0]), 1e-9);
      EXPECT_NEAR(pixel->y, static_cast<double>(expected[1]), 1e-9);
    }
  }
}

TEST(SimulateLens, InvertsItself) {
  const Lens lens(obliqueLens());
  for (double x = -0.7; x <= 0.7; x += 0.1) {
    for (double y = -0.7; y <= 0.7; y += 0.1) {
      const auto back = lens.rayFromPixel(lens.pixelFromRay({x, y}).value());
      ASSERT_TRUE(back) << x << ", " << y;
      EXPECT_NEAR(back->x, x, 1e-12);
      EXPECT_NEAR(back->y, y, 1e-12);
    }
  }
}

TEST(SimulateLens, ShowsNothingBeyondItsFold) {
  Optics optics = obliqueLens();
  optics.radial = {-0.5, 0, 0};  // turns where 1 = 1.5 r^2
  optics.tangential = {};
  const Lens lens(optics);
  EXPECT_NEAR(lens.foldRadius(), std::sqrt(1 / 1.5), 0.01);
  EXPECT_FALSE(lens.pixelFromRay({0.9, 0}));
  const double farthest = optics.focal * 0.8165 * (1 - 0.5 * 0.8165 * 0.8165);
  EXPECT_TRUE(lens.rayFromPixel({optics.principal.x + 0.99 * farthest, optics.principal.y}));
  EXPECT_FALSE(lens.rayFromPixel({optics.principal.x + 1.05 * farthest, optics.principal.y}));
}

TEST(SimulatePose, TurnsAsItsNamesSay) {
  const glm::dvec3 ahead(0, 0, 1);
  EXPECT_GT((roomFromDevice({10, 0, 0}) * ahead).x, 0.17);                // yaw looks to the right
  EXPECT_LT((roomFromDevice({0, 10, 0}) * ahead).y, -0.17);               // pitch looks up
  EXPECT_GT((roomFromDevice({0, 0, 10}) * glm::dvec3(1, 0, 0)).y, 0.17);  // roll is clockwise to the eye
  const glm::dmat3 rotation = roomFromDevice({12, -7, 3});
  EXPECT_NEAR(glm::dot(glm::cross(rotation[0], rotation[1]), rotation[2]), 1, 1e-15);
  EXPECT_NEAR(glm::dot(rotation[0], rotation[2]), 0, 1e-15);
}

TEST(SimulatePose, SquareOnIsASimilarity) {
  Optics optics;
  optics.focal = 1000;
  optics.principal = {500, 400};
  const PlacedOptics device(Pose{{200, 100, -2000}, {}}, optics);
  const auto point = device.wallFromPixel(PlanarScreen(), {600, 350});
  ASSERT_TRUE(point);
  EXPECT_NEAR(point->x, 200 + 2 * 100, 1e-9);
  EXPECT_NEAR(point->y, 100 - 2 * 50, 1e-9);
}

TEST(SimulatePose, SeesNothingBehindOrBeside) {
  Optics optics;
  optics.focal = 1000;
  const PlacedOptics away(Pose{{0, 0, -1000}, {180, 0, 0}}, optics);
  EXPECT_FALSE(away.wallFromPixel(PlanarScreen(), {0, 0}));
  EXPECT_FALSE(away.pixelFromWall(PlanarScreen(), {0, 0}));
  const PlacedOptics behindTheWall(Pose{{0, 0, 1000}, {180, 0, 0}}, optics);
  EXPECT_FALSE(behindTheWall.pixelFromWall(PlanarScreen(), {0, 0}));
  EXPECT_FALSE(behindTheWall.wallFromPixel(PlanarScreen(), {0, 0}));
}

TEST(SimulatePose, PixelToWallToPixelIsTheSame) {
  const SimulatedWall wall(reportRig(8));
  for (std::size_t i = 0; i < wall.projectorCount(); ++i) {
    const auto size = wall.rig().projectors[i].resolution;
    for (int k = 0; k <= 100; ++k) {
      const glm::dvec2 pixel(size.width * (k % 11) / 10.0, size.height * (k / 10) / 10.0);
      const auto back = wall.projectorFromWall(i, wall.wallFromProjector(i, pixel).value());
      ASSERT_TRUE(back);
      EXPECT_LT(glm::distance(*back, pixel), 1e-9);
    }
  }
}

}  // namespace
}  // namespace pixelflex::calib
