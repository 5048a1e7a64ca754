#include <gtest/gtest.h>

#include "calib/geometry/footprint.h"
#include "calib/geometry/nudge_map.h"
#include "calib/geometry/projector_mapping.h"

namespace pixelflex::calib {
namespace {

void expectNear(glm::dvec2 a, glm::dvec2 b) {
  EXPECT_NEAR(a.x, b.x, 1e-9);
  EXPECT_NEAR(a.y, b.y, 1e-9);
}

TEST(Nudge, MovesRollsAndBends) {
  expectNear(nudgedFromMeasured({.shift = {3, -2}}, {640, 480}).map({100, 50}), {103, 48});
  expectNear(nudgedFromMeasured({.roll = 90}, {640, 480}).map({320 + 10, 240}), {320, 250});
  const Homography bent = nudgedFromMeasured({.corners = {{{5, 1}, {0, 0}, {-4, 2}, {0, 3}}}}, {640, 480});
  expectNear(bent.map({0, 0}), {5, 1});
  expectNear(bent.map({640, 0}), {640, 0});
  expectNear(bent.map({640, 480}), {636, 482});
  expectNear(bent.map({0, 480}), {0, 483});
}

TEST(Nudge, RefusesAFoldedFrame) {
  EXPECT_THROW((void)nudgedFromMeasured({.corners = {{{700, 500}, {0, 0}, {0, 0}, {0, 0}}}}, {640, 480}),
               GeometryError);
}

TEST(Nudge, MovesThePictureNotTheWall) {
  ProjectorCalibration projector{.name = "p1", .resolution = {640, 480}};
  projector.model = {
      .projectorFromWall = {0.5, 0.01, 3, 0.02, 0.5, 4, 1e-5, 2e-5, 1}, .centre = {300, 200}, .scale = 1};
  const ProjectorMapping measured(projector);
  projector.nudge = Nudge{.shift = {7, 9}};
  const ProjectorMapping nudged(projector);
  const glm::dvec2 wall = *measured.wallFromProjector({200, 150});
  expectNear(*nudged.projectorFromWall(wall), {207, 159});
  expectNear(*nudged.wallFromProjector({207, 159}), wall);
  expectNear(nudged.flatWallFromProjector().map({207, 159}), measured.flatWallFromProjector().map({200, 150}));
}

}  // namespace
}  // namespace pixelflex::calib
