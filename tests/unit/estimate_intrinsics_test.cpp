#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "calib/estimate/intrinsics.h"

namespace pixelflex::calib {
namespace {

using ::testing::HasSubstr;

const Checkerboard kBoard{9, 6, 30};
constexpr devices::Size kSize{1280, 720};
constexpr double kFocal = 1100;

struct Pose {
  double tilt = 0;  // degrees, about an axis in the board's plane at angle `axis`
  double axis = 0;
  glm::dvec2 at{640, 360};  // the board's middle in the picture
  double distance = 700;    // millimetres
};

/// The corners that a lens with k1 = -0.1 sees of the board, with a little noise.
CheckerboardView viewOf(const std::string& name, const Pose& pose, std::mt19937& random) {
  constexpr double kDegree = std::numbers::pi / 180;
  std::normal_distribution<double> noise(0, 0.05);
  const double c = std::cos(pose.axis * kDegree);
  const double s = std::sin(pose.axis * kDegree);
  CheckerboardView view{name, {}};
  for (int row = 0; row < kBoard.rows; ++row) {
    for (int column = 0; column < kBoard.columns; ++column) {
      const double x = kBoard.square * (column - 4);
      const double y = kBoard.square * (row - 2.5);
      const double along = c * x + s * y;
      const double across = (-s * x + c * y) * std::cos(pose.tilt * kDegree);
      const double z = pose.distance + (-s * x + c * y) * std::sin(pose.tilt * kDegree);
      const double u = (c * along - s * across + (pose.at.x - 640) * pose.distance / kFocal) / z;
      const double v = (s * along + c * across + (pose.at.y - 360) * pose.distance / kFocal) / z;
      const double bend = 1 - 0.1 * (u * u + v * v);
      view.corners.emplace_back(640 + kFocal * u * bend + noise(random), 360 + kFocal * v * bend + noise(random));
    }
  }
  return view;
}

/// Twelve boards all over the picture, tilted by up to `tilt`.
std::vector<CheckerboardView> views(double tilt, bool corners = true) {
  std::mt19937 random(3);
  std::vector<CheckerboardView> result;
  for (int i = 0; i < 12; ++i) {
    const double spread = corners ? 1 : 0;
    const Pose pose{.tilt = tilt * (0.6 + 0.4 * (i % 2)),
                    .axis = 30.0 * i,
                    .at = {640 + spread * 400 * (i % 3 - 1), 360 + spread * 200 * (i / 3 % 3 - 1)},
                    .distance = 700 + 20.0 * i};
    result.push_back(viewOf("checkerboard/" + std::to_string(i + 1) + ".png", pose, random));
  }
  return result;
}

std::string refusal(const std::vector<CheckerboardView>& seen) {
  try {
    (void)calibrateCamera(seen, kBoard, kSize);
  } catch (const EstimateError& error) {
    return error.what();
  }
  return "";
}

TEST(CalibrateCamera, TiltedBoardsAllOverThePictureNeedNoRemark) {
  std::vector<std::string> remarks;
  const CameraIntrinsics camera = calibrateCamera(views(35), kBoard, kSize, &remarks);
  EXPECT_NEAR(camera.fx, kFocal, 3);
  EXPECT_NEAR(camera.radial[0], -0.1, 0.02);
  EXPECT_NEAR(camera.cx, 640, 3);
  EXPECT_THAT(remarks, ::testing::IsEmpty());
}

TEST(CalibrateCamera, RefusesBoardsThatAreNeverTilted) {
  const std::string text = refusal(views(1));
  EXPECT_THAT(text, HasSubstr("checkerboard/1.png, checkerboard/2.png, checkerboard/3.png, checkerboard/4.png, ..."));
  EXPECT_THAT(text, HasSubstr("do not determine the camera"));
  EXPECT_THAT(text, HasSubstr("tilt the board"));
}

TEST(CalibrateCamera, RefusesPhotographsThatAreAllAlike) {
  std::mt19937 random(8);
  std::vector<CheckerboardView> alike;
  for (int i = 0; i < 10; ++i) {
    alike.push_back(viewOf("b" + std::to_string(i), {.tilt = 20.0 + 0.2 * i, .at = {600.0 + 2 * i, 350}}, random));
  }
  EXPECT_THAT(refusal(alike), HasSubstr("nearly the same tilt"));
}

TEST(CalibrateCamera, NamesRepetitionsAndCountsThemOnce) {
  auto seen = views(35);
  auto copy = seen[2];
  copy.name = "checkerboard/copy.png";
  seen.push_back(copy);
  std::vector<std::string> remarks;
  EXPECT_EQ(calibrateCamera(seen, kBoard, kSize, &remarks).photos, 12);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_THAT(remarks[0], HasSubstr("checkerboard/copy.png like checkerboard/3.png"));

  const std::vector<CheckerboardView> one(5, seen[0]);
  EXPECT_THAT(refusal(one), HasSubstr("found in 1 different photographs"));
  EXPECT_THAT(refusal(one), HasSubstr("checkerboard/1.png like checkerboard/1.png"));
}

TEST(CalibrateCamera, RemarksOnCornersWithoutABoard) {
  std::vector<std::string> remarks;
  (void)calibrateCamera(views(35, false), kBoard, kSize, &remarks);
  ASSERT_FALSE(remarks.empty());
  EXPECT_THAT(remarks.back(), HasSubstr("upper left, upper right, lower left, lower right"));
}

}  // namespace
}  // namespace pixelflex::calib
