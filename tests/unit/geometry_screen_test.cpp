#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>

#include "calib/geometry/projector_mapping.h"
#include "calib/geometry/residual_map.h"
#include "calib/geometry/screen_view.h"

namespace pixelflex::calib {
namespace {

void expectNear(glm::dvec2 a, glm::dvec2 b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
}

/// A pinhole at `eye` that looks along +Z with focal length 1, as a view of a cylinder of this radius.
ScreenView viewFrom(glm::dvec3 eye, double radius, double apex) {
  // (X - ex, Y - ey, Z - ez): the columns of X, Y, 1 and Z.
  const Homography h({1, 0, -eye.x, 0, 1, -eye.y, 0, 0, -eye.z});
  return ScreenView(h, Bend{radius, apex, {0, 0, 1}});
}

TEST(ScreenView, SeesABentScreenWhereTrigonometrySaysItIs) {
  // Ninety degrees of arc to the right of the apex lie a radius aside and a radius nearer to the audience.
  const double radius = 2000;
  const double arc = radius * 0.5;
  const glm::dvec3 eye(300, -100, -1500);
  const glm::dvec3 there(50 + radius * std::sin(0.5), 700, radius * std::cos(0.5) - radius);
  const glm::dvec3 ray = there - eye;
  expectNear(viewFrom(eye, radius, 50).imageFromWall({50 + arc, 700}), glm::dvec2(ray) / ray.z, 1e-12);
}

TEST(ScreenView, FindsTheWallPointOfARayOnHollowAndBulgingScreens) {
  for (const double radius : {3000.0, -3000.0}) {
    for (const double distance : {1500.0, 4000.0, 9000.0}) {  // within the cylinder and outside it
      const ScreenView view = viewFrom({200, 400, -distance}, radius, 100);
      for (double x = -1200; x <= 1400; x += 200) {
        const auto back = view.wallFromImage(view.imageFromWall({x, 0.4 * x}));
        ASSERT_TRUE(back) << radius << " " << distance << " " << x;
        expectNear(*back, {x, 0.4 * x}, 1e-7);
      }
    }
  }
}

TEST(ScreenView, RaysPastTheScreenFindNothing) {
  EXPECT_FALSE(viewFrom({0, 0, -6000}, -1000, 0).wallFromImage({0.9, 0}));
}

TEST(ScreenView, TheTangentAgreesToFirstOrder) {
  const ScreenView view = viewFrom({200, 400, -2500}, 3000, 100);
  const glm::dvec2 at{-700, 300};
  const Homography tangent = view.imageFromTangent(at);
  expectNear(tangent.map(at), view.imageFromWall(at), 1e-12);
  const double near = glm::length(tangent.map(at + 1.0) - view.imageFromWall(at + 1.0));
  const double far = glm::length(tangent.map(at + 2.0) - view.imageFromWall(at + 2.0));
  EXPECT_NEAR(far / near, 4, 0.1);
}

TEST(ScreenView, OfACameraIsTheInverseOfItsCollineation) {
  const SurfaceFit surface{{2, 0.1, 30, -0.2, 1.7, -20, 1e-4, -2e-4, 1}, 0, Bend{1500, 40, {0.1, 0.02, 1e-4}}};
  const ScreenView view(surface);
  const glm::dvec2 apex{40, 77};  // on the plane of the collineation
  expectNear(Homography(surface.wallFromCamera).map(view.imageFromWall(apex)), apex, 1e-9);
  expectNear(view.wallFromImage(view.imageFromWall({300, 200})).value_or(glm::dvec2(0)), {300, 200}, 1e-7);
}

ResidualSpline wavySpline(double amplitude) {
  ResidualSpline spline{6, 5, {}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> offset(-amplitude, amplitude);
  for (int i = 0; i < 9 * 8; ++i) spline.control.emplace_back(offset(random), offset(random));
  return spline;
}

TEST(ResidualMap, WeightsSumToOneAndConstantsAreExact) {
  const ResidualSpline spline{4, 3, std::vector<glm::dvec2>(7 * 6, {1.5, -2})};
  const ResidualMap map(spline, {640, 480});
  for (const glm::dvec2 p : {glm::dvec2(0, 0), glm::dvec2(640, 480), glm::dvec2(123.4, 321), glm::dvec2(-50, 900)}) {
    expectNear(map.apply(p), p + glm::dvec2(1.5, -2), 1e-12);
  }
}

TEST(ResidualMap, InvertsItself) {
  const ResidualMap map(wavySpline(20), {1024, 768});
  for (int y = -20; y <= 800; y += 41) {
    for (int x = -20; x <= 1060; x += 45) {
      const auto back = map.invert({x, y});
      ASSERT_TRUE(back);
      expectNear(map.apply(*back), {x, y}, 1e-9);
    }
  }
}

TEST(ResidualMap, IsSmoothAcrossCells) {
  const ResidualMap map(wavySpline(20), {1024, 768});
  const double border = 1024 / 6.0;
  const auto slope = [&](double x) { return (map.apply({x + 1e-4, 300}) - map.apply({x - 1e-4, 300})) / 2e-4; };
  expectNear(slope(border - 1e-3), slope(border + 1e-3), 1e-4);
}

TEST(ProjectorMapping, RoundTripsOnABentScreenWithResidual) {
  ProjectorModel model{.projectorFromWall = {1.2e-3, 5e-5, -0.9, -3e-5, 1.15e-3, -0.5, 4e-5, 2e-5, 1},
                       .centre = {520, 300},
                       .scale = 1024,
                       .radial = {-0.05, 0.02, 0},
                       .tangential = {1e-3, -5e-4}};
  model.bend = Bend{2500, 600, {-1e-4, -5e-5, 4e-4}};
  model.residual = wavySpline(3);
  const ProjectorMapping mapping(model, {1024, 768});
  for (int y = 0; y <= 768; y += 64) {
    for (int x = 0; x <= 1024; x += 64) {
      const auto wall = mapping.wallFromProjector({x, y});
      ASSERT_TRUE(wall);
      const auto back = mapping.projectorFromWall(*wall);
      ASSERT_TRUE(back);
      expectNear(*back, {x, y}, 1e-7);
    }
  }
}

}  // namespace
}  // namespace pixelflex::calib
