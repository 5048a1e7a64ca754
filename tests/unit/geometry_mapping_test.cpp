#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "calib/geometry/brown_lens.h"
#include "calib/geometry/camera_mapping.h"
#include "calib/geometry/homography.h"
#include "calib/geometry/projector_mapping.h"

namespace pixelflex::calib {
namespace {

void expectNear(glm::dvec2 a, glm::dvec2 b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
}

TEST(Homography, InverseAndProductUndoEachOther) {
  const Homography h({1.1, 0.1, 30, -0.05, 0.9, -20, 1e-4, -2e-4, 1});
  const glm::dvec2 p{123.4, -56.7};
  expectNear(h.inverse().map(h.map(p)), p, 1e-9);
  const Homography moved = Homography::translation({5, 7}) * Homography::scaling({2, 3});
  expectNear(moved.map({10, 10}), {25, 37}, 1e-12);
}

TEST(BrownLens, DistortsByTheTextbook) {
  // k1 alone at radius 0.5: x (1 + k1 r^2); p1, p2 by hand at (0.3, 0.2).
  expectNear(BrownLens({-0.2, 0, 0}, {0, 0}).distort({0.5, 0}), {0.5 * (1 - 0.2 * 0.25), 0}, 1e-15);
  const double r2 = 0.13;
  expectNear(BrownLens({0, 0, 0}, {0.01, -0.02}).distort({0.3, 0.2}),
             {0.3 + 2 * 0.01 * 0.06 - 0.02 * (r2 + 0.18), 0.2 + 0.01 * (r2 + 0.08) + 2 * -0.02 * 0.06}, 1e-15);
}

TEST(BrownLens, UndistortInvertsToTheLastDigits) {
  const BrownLens lens({-0.28, 0.08, -0.01}, {0.001, -0.002});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-0.7, 0.7);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec2 ideal{coordinate(random), coordinate(random)};
    const auto back = lens.undistort(lens.distort(ideal));
    ASSERT_TRUE(back);
    expectNear(*back, ideal, 1e-11);
  }
}

TEST(BrownLens, RefusesPointsBeyondTheFold) {
  const BrownLens lens({-0.3, 0, 0}, {0, 0});
  EXPECT_NEAR(lens.foldRadius(), std::sqrt(1 / 0.9), 0.02);
  EXPECT_FALSE(lens.undistort({3, 0}));
}

TEST(CameraMapping, RoundTripAndCentre) {
  const CameraIntrinsics camera{.size = {1920, 1080},
                                .fx = 1600,
                                .fy = 1590,
                                .cx = 950,
                                .cy = 560,
                                .radial = {-0.12, 0.05, 0},
                                .tangential = {1e-3, 0}};
  const CameraMapping mapping(camera);
  expectNear(mapping.undistortedFromRaw({950, 560}), {950, 560}, 1e-9);
  for (const glm::dvec2 p : {glm::dvec2(3, 4), glm::dvec2(1900, 20), glm::dvec2(700, 1079)}) {
    expectNear(mapping.rawFromUndistorted(mapping.undistortedFromRaw(p)), p, 1e-8);
  }
}

ProjectorModel obliqueProjector() {
  // Wall units are millimetres; about 1.2 pixels each, keystoned, with a lens off its middle.
  return {.projectorFromWall = {1.2e-3, 5e-5, -0.9, -3e-5, 1.15e-3, -0.5, 4e-5, 2e-5, 1},
          .centre = {520, 300},
          .scale = 1024,
          .radial = {-0.05, 0.02, 0},
          .tangential = {1e-3, -5e-4}};
}

TEST(ProjectorMapping, RoundTripsOverTheWholeFrame) {
  const ProjectorMapping mapping(obliqueProjector(), {1024, 768});
  for (int y = 0; y <= 768; y += 64) {
    for (int x = 0; x <= 1024; x += 64) {
      const auto wall = mapping.wallFromProjector({x, y});
      ASSERT_TRUE(wall);
      const auto back = mapping.projectorFromWall(*wall);
      ASSERT_TRUE(back);
      expectNear(*back, {x, y}, 1e-8);
    }
  }
}

TEST(ProjectorMapping, RefusesWallPointsFarOutsideInsteadOfFoldingThemIn) {
  ProjectorModel model = obliqueProjector();
  model.radial = {-0.2, 0, 0};
  const ProjectorMapping mapping(model, {1024, 768});
  int accepted = 0;
  for (double angle = 0; angle < 6.28; angle += 0.05) {
    const glm::dvec2 far = glm::dvec2(800, 500) + 6000.0 * glm::dvec2(std::cos(angle), std::sin(angle));
    const auto p = mapping.projectorFromWall(far);
    if (p && mapping.insideFrame(*p)) ++accepted;
  }
  EXPECT_EQ(accepted, 0);
}

TEST(ProjectorMapping, DensityIsPixelsPerWallUnit) {
  const ProjectorModel square{.projectorFromWall = {2, 0, 0, 0, 2, 0, 0, 0, 1}, .centre = {0, 0}, .scale = 1};
  EXPECT_NEAR(ProjectorMapping(square, {100, 100}).meanDensity(), 2, 1e-9);
}

}  // namespace
}  // namespace pixelflex::calib
