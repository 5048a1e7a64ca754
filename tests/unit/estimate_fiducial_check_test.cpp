#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <vector>

#include "calib/estimate/fiducial_check.h"

namespace pixelflex::calib {
namespace {

using ::testing::HasSubstr;

const CameraIntrinsics kCamera{.size = {1920, 1080}, .fx = 1500, .fy = 1505, .cx = 940, .cy = 560};

/// The camera stands before the middle of the wall, turned and tilted: plain trigonometry, no homography.
glm::dvec2 cameraFromWall(glm::dvec2 p, double yaw, double pitch) {
  const double x = p.x - 1400;
  const double y = p.y - 700;
  const double z = 3200;
  const double xTurned = std::cos(yaw) * x - std::sin(yaw) * z;
  const double zTurned = std::sin(yaw) * x + std::cos(yaw) * z;
  const double yTilted = std::cos(pitch) * y - std::sin(pitch) * zTurned;
  const double zTilted = std::sin(pitch) * y + std::cos(pitch) * zTurned;
  return {kCamera.cx + kCamera.fx * xTurned / zTilted, kCamera.cy + kCamera.fy * yTilted / zTilted};
}

struct Fiducials {
  std::vector<PointPair> pairs;
  std::vector<std::string> names;
  [[nodiscard]] std::optional<std::string> explained() const { return explainFiducials(pairs, names, kCamera); }
};

/// Four corners and two more; measured to 2 mm and seen to 0.1 pixels.
Fiducials fiducials(std::size_t count, double yaw = 0.2, double pitch = -0.1) {
  const std::vector<glm::dvec2> places = {{0, 0}, {3000, 0}, {3000, 1500}, {0, 1500}, {1100, 600}, {1480, 1510}};
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 1);
  const auto some = [&](double sigma) { return sigma * glm::dvec2(noise(random), noise(random)); };
  Fiducials result;
  for (std::size_t i = 0; i < count; ++i) {
    result.pairs.push_back({cameraFromWall(places[i] + some(2), yaw, pitch) + some(0.1), places[i]});
    result.names.push_back(std::to_string(i));
  }
  return result;
}

TEST(FiducialCheck, SaysNothingOfGoodOnes) {
  for (const std::size_t count : {4U, 5U, 6U}) {
    EXPECT_FALSE(fiducials(count).explained()) << count;
    EXPECT_FALSE(fiducials(count, 0, 0).explained()) << count;
    EXPECT_FALSE(fiducials(count, -0.5, 0.2).explained()) << count;
  }
}

TEST(FiducialCheck, NamesAMistypedOneAndItsPlace) {
  for (const std::size_t count : {5U, 6U}) {
    Fiducials wrong = fiducials(count);
    wrong.pairs[2].target.y = 150;
    const auto text = wrong.explained();
    ASSERT_TRUE(text) << count;
    EXPECT_THAT(*text, HasSubstr("fiducial 2 is measured as at: [3000, 150], but is seen at about [")) << count;
    EXPECT_THAT(*text, ::testing::AnyOf(HasSubstr("149"), HasSubstr("150"))) << count;
  }
}

TEST(FiducialCheck, NamesEachThatMayBeMistyped) {
  for (std::size_t i = 0; i < 6; ++i) {
    Fiducials wrong = fiducials(6);
    wrong.pairs[i].target.x += 300;
    ASSERT_TRUE(wrong.explained()) << i;
    EXPECT_THAT(*wrong.explained(), HasSubstr("fiducial " + std::to_string(i) + " is measured")) << i;
  }
}

TEST(FiducialCheck, NamesTwoThatAreExchanged) {
  for (const std::size_t count : {4U, 5U, 6U}) {
    Fiducials wrong = fiducials(count);
    std::swap(wrong.pairs[1].target, wrong.pairs[2].target);
    ASSERT_TRUE(wrong.explained()) << count;
    EXPECT_THAT(*wrong.explained(), HasSubstr("fiducials 1 [3000, 1500] and 2 [3000, 0] seem to be exchanged"))
        << count;
  }
}

TEST(FiducialCheck, FourMustBeAPlaneBeforeThisCamera) {
  Fiducials wrong = fiducials(4);
  wrong.pairs[3].target.y = 1050;
  ASSERT_TRUE(wrong.explained());
  EXPECT_THAT(*wrong.explained(), HasSubstr("the four fiducials (0, 1, 2, 3) cannot be a flat wall"));
  Fiducials inches = fiducials(4);
  for (auto& pair : inches.pairs) pair.target.y /= 2.54;
  ASSERT_TRUE(inches.explained());
  EXPECT_THAT(*inches.explained(), HasSubstr("units"));
}

TEST(FiducialCheck, WritesPlacesInTheWallsUnits) {
  Fiducials metres = fiducials(6);
  for (auto& pair : metres.pairs) pair.target *= 0.001;
  metres.pairs[4].target.x = 2.5;
  ASSERT_TRUE(metres.explained());
  EXPECT_THAT(*metres.explained(), HasSubstr("fiducial 4 is measured as at: [2.500, 0.600]"));
}

TEST(FiducialCheck, ABentScreenIsNoMistypedFiducial) {
  Fiducials bent = fiducials(4);
  for (const double y : {0., 1500.}) {  // the middles of the upper and the lower edge, nearer to the camera
    const glm::dvec2 place{1500, y};
    bent.pairs.push_back({cameraFromWall(place, 0.2, -0.1) + glm::dvec2(0, y > 0 ? 25 : -25), place});
    bent.names.emplace_back(y > 0 ? "5" : "4");
  }
  const auto text = bent.explained();
  EXPECT_FALSE(text) << *text;
}

}  // namespace
}  // namespace pixelflex::calib
