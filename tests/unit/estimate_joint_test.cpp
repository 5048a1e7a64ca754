#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "calib/estimate/bent_screen.h"
#include "calib/estimate/joint_solve.h"
#include "calib/geometry/projector_mapping.h"
#include "calib/geometry/screen_view.h"

namespace pixelflex::calib {
namespace {

constexpr devices::Size kFrame{800, 600};

/// Six projectors in a row, 700 mm apart, each 900 mm wide; four camera places see two and a half each.
class PlacesTest : public ::testing::Test {
 protected:
  static ProjectorMapping projector(std::size_t i) {
    const double left = 700.0 * static_cast<double>(i);
    ProjectorModel model{
        .projectorFromWall = {1.1e-3, 4e-5, -1.1e-3 * left - 0.49, -3e-5, 1.12e-3, -0.35, 3e-5, -2e-5, 1},
        .centre = {390, 310},
        .scale = 800,
        .radial = {-0.04, 0.02, 0}};
    return {model, kFrame};
  }
  static Homography cameraFromWall(std::size_t place) {
    const double left = 800.0 * static_cast<double>(place);
    return Homography({0.95, 0.02, -0.95 * left + 50, -0.015, 0.97, 120, 2e-5, -3e-5, 1.0 - 2e-5 * left});
  }
  void SetUp() override {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 0.03);
    const auto seen = [&](std::size_t place, glm::dvec2 wall) {
      return cameraFromWall(place).map(wall) + glm::dvec2(noise(random), noise(random));
    };
    problem_.resolutions.assign(6, kFrame);
    for (std::size_t place = 0; place < 4; ++place) {
      auto& fiducials = problem_.fiducials.emplace_back();
      for (const double x : {800.0 * double(place) + 300, 800.0 * double(place) + 1500}) {
        const double y = place % 2 == 0 ? -60 : 900;
        fiducials.push_back({seen(place, {x, y}), {x, y}});
      }
      for (std::size_t i = 0; i < 6; ++i) addObservation(place, i, seen);
    }
  }
  void addObservation(std::size_t place, std::size_t i, const auto& seen) {
    JointObservation observation{place, i, {}};
    for (int k = 0; k < 100; ++k) {
      const glm::dvec2 p(20 + 760.0 * (k % 10) / 9, 20 + 560.0 * static_cast<int>(k / 10) / 9);
      const glm::dvec2 wall = *projector(i).wallFromProjector(p);
      const glm::dvec2 raw = cameraFromWall(place).map(wall);
      if (raw.x > 0 && raw.x < 1900) observation.points.push_back({p, seen(place, wall)});
    }
    if (!observation.points.empty()) problem_.observations.push_back(observation);
  }
  /// Largest distance of a wall point seen from a place to the truth, mm.
  static double worst(const std::vector<SurfaceFit>& places) {
    double largest = 0;
    for (std::size_t place = 0; place < places.size(); ++place) {
      const ScreenView view(places[place]);
      for (const double x : {200.0, 900.0, 1500.0}) {
        const glm::dvec2 wall(800.0 * double(place) + x, 300);
        const auto found = view.wallFromImage(cameraFromWall(place).map(wall));
        largest = std::max(largest, glm::length(found.value_or(glm::dvec2(1e6)) - wall));
      }
    }
    return largest;
  }
  JointProblem problem_;
};

TEST_F(PlacesTest, SolvedTogetherTheyAgree) {
  const auto places = solvePlaces(problem_);
  ASSERT_EQ(places.size(), 4U);
  EXPECT_LT(worst(places), 0.25);  // millimetres, a quarter of a pixel, from eight noisy markers
  // What two places see of one wall point is one place on the wall, to hundredths.
  const glm::dvec2 shared(1500, 300);
  const auto a = ScreenView(places[0]).wallFromImage(cameraFromWall(0).map(shared));
  const auto b = ScreenView(places[1]).wallFromImage(cameraFromWall(1).map(shared));
  EXPECT_LT(glm::length(*a - *b), 0.03);
}

TEST_F(PlacesTest, APlaceThatSharesNothingIsNamed) {
  std::erase_if(problem_.observations, [](const JointObservation& o) { return (o.place == 3) != (o.projector == 5); });
  EXPECT_THAT([&] { (void)solvePlaces(problem_); },
              ::testing::ThrowsMessage<EstimateError>(::testing::HasSubstr("camera place 4 shares only 0 points")));
}

TEST_F(PlacesTest, FourFiducialsAreNeededInAll) {
  for (auto& fiducials : problem_.fiducials) fiducials.clear();
  EXPECT_THROW((void)solvePlaces(problem_), EstimateError);
}

/// A camera of 1500 pixels focal length before a hollow cylinder of 3 m, looking a little down and aside.
class BentTest : public ::testing::Test {
 protected:
  static glm::dvec2 seen(glm::dvec2 wall, double radius) {
    const double t = (wall.x - 1000) / radius;
    const glm::dvec3 at(1000 + radius * std::sin(t), wall.y, radius * (std::cos(t) - 1));
    const glm::dvec3 from = at - glm::dvec3(800, 200, -3500);
    const double c = std::cos(0.05);
    const double s = std::sin(0.05);
    const glm::dvec3 turned(c * from.x - s * from.z, from.y, s * from.x + c * from.z);
    return {1500 * turned.x / turned.z + 960, 1500 * turned.y / turned.z + 540};
  }
  /// The pixel of a projector with a k1 of -0.03, to the right of the middle and turned back to it.
  static glm::dvec2 litBy(glm::dvec2 wall) {
    const double t = (wall.x - 1000) / 3000;
    const glm::dvec3 at(1000 + 3000 * std::sin(t), wall.y, 3000 * (std::cos(t) - 1));
    const glm::dvec3 from = at - glm::dvec3(1150, 700, -1500);
    const double c = std::cos(-0.12);
    const double s = std::sin(-0.12);
    const glm::dvec3 turned(c * from.x - s * from.z, from.y, s * from.x + c * from.z);
    const glm::dvec2 n = glm::dvec2(turned) / turned.z;
    return 1250.0 * n * (1 - 0.03 * glm::dot(n, n)) + glm::dvec2(400, 500);
  }
  static std::vector<PointPair> fiducials(double radius) {
    std::vector<PointPair> pairs;
    for (const double x : {0.0, 700.0, 1400.0, 2100.0}) {
      for (const double y : {0.0, 1100.0}) pairs.push_back({seen({x, y}, radius), {x, y}});
    }
    return pairs;
  }
  static constexpr CameraIntrinsics kCamera{.size = {1920, 1080}, .fx = 1500, .fy = 1500, .cx = 960, .cy = 540};
};

TEST_F(BentTest, ACylinderIsUnrolledFromItsFiducials) {
  for (const double radius : {3000.0, -3000.0}) {
    const SurfaceFit fit = fitCylinder(fiducials(radius), kCamera, 3000);
    EXPECT_EQ(fit.bend->radius, radius);
    EXPECT_LT(fit.rms, 1e-6);
    const ScreenView view(fit);
    for (const glm::dvec2 wall : {glm::dvec2(100, 500), glm::dvec2(1050, 20), glm::dvec2(1900, 1000)}) {
      const auto found = view.wallFromImage(seen(wall, radius));
      ASSERT_TRUE(found);
      EXPECT_LT(glm::length(*found - wall), 1e-4);
    }
  }
}

TEST_F(BentTest, FiducialsTellTheBow) {
  const auto bow = bowOfFiducials(fiducials(2500), kCamera);
  ASSERT_TRUE(bow);
  EXPECT_NEAR(bow->radius, 2500, 25);
  EXPECT_NEAR(bow->height, 2100 * 2100 / (8 * 2500.0), 3);
  EXPECT_FALSE(bowOfFiducials(fiducials(1e9), kCamera));
}

TEST_F(BentTest, AProjectorTellsTheBowToo) {
  // Its rays meet the bent screen; four fiducials alone could not say that it is not flat.
  std::vector<PointPair> points;
  for (int k = 0; k < 100; ++k) {
    const glm::dvec2 wall(500 + 900.0 * (k % 10) / 9, 200 + 650.0 * static_cast<int>(k / 10) / 9);
    points.push_back({litBy(wall), seen(wall, 3000)});
  }
  auto corners = fiducials(3000);
  const std::vector<PointPair> four = {corners[0], corners[1], corners[6], corners[7]};
  const auto bow = bowOfProjector(points, kFrame, four, kCamera);
  ASSERT_TRUE(bow);
  EXPECT_NEAR(bow->radius, 3000, 300);
  EXPECT_GT(bow->flatError, 0.2);
}

}  // namespace
}  // namespace pixelflex::calib
