#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <vector>

#include "calib/simulate/aruco_4x4.h"
#include "calib/simulate/board.h"
#include "calib/simulate/rig_generator.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::Scene;

cv::Mat greyOf(const Image8& photo) {
  cv::Mat grey(photo.height(), photo.width(), CV_8U);
  for (int y = 0; y < photo.height(); ++y) {
    for (int x = 0; x < photo.width(); ++x) grey.at<std::uint8_t>(y, x) = photo.at(x, y, 1);
  }
  return grey;
}

TEST(SimulateMarkers, PatternsAreTheDictionary) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  const auto patterns = arucoPatterns4x4();
  ASSERT_EQ(static_cast<int>(patterns.size()), dictionary->bytesList.rows);
  for (int id = 0; id < 50; ++id) {
    const cv::Mat bits = cv::aruco::Dictionary::getBitsFromByteList(dictionary->bytesList.rowRange(id, id + 1), 4);
    for (int module = 0; module < 36; ++module) {
      const int x = module % 6;
      const int y = module / 6;
      const bool border = x == 0 || y == 0 || x == 5 || y == 5;
      const bool white = !border && bits.at<std::uint8_t>(y - 1, x - 1) != 0;
      EXPECT_EQ(arucoIsWhite(id, (x + 0.5) / 6, (y + 0.5) / 6), white) << "id " << id << ", module " << module;
    }
  }
}

/// Looks for the markers as the camera sees them where it stands; how many are where they should be.
std::size_t checkMarkers(SimulatedWall& wall, int place) {
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
  auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  cv::aruco::detectMarkers(greyOf(wall.camera().shoot()), cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50),
                           corners, ids, parameters);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto& marker = wall.rig().markers.at(static_cast<std::size_t>(ids[i]));
    const double angle = marker.roll * CV_PI / 180;
    const glm::dvec2 right = 0.5 * marker.side * glm::dvec2(std::cos(angle), std::sin(angle));
    const glm::dvec2 down(-right.y, right.x);
    const std::vector<glm::dvec2> truth{marker.centre - right - down, marker.centre + right - down,
                                        marker.centre + right + down, marker.centre - right + down};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto pixel = wall.cameraFromWall(truth[k], place).value();
      EXPECT_NEAR(corners[i][k].x + 0.5, pixel.x, 0.35);
      EXPECT_NEAR(corners[i][k].y + 0.5, pixel.y, 0.35);
    }
    EXPECT_GE(std::hypot(corners[i][1].x - corners[i][0].x, corners[i][1].y - corners[i][0].y), 40);
  }
  return ids.size();
}

TEST(SimulateMarkers, AreFoundInRoomLightWhereTheyHang) {
  for (const Rig& rig : {reportRig(8), cylinderRig(1)}) {
    SimulatedWall wall(rig);
    ASSERT_TRUE(wall.person().arrange(Scene::kRoomLight, 0));
    EXPECT_EQ(checkMarkers(wall, 0), rig.markers.size());
  }
}

TEST(SimulateMarkers, AreFoundFromFurtherPlaces) {
  SimulatedWall wall(largeRig(1));
  ASSERT_TRUE(wall.person().arrange(Scene::kRoomLight, 0));
  ASSERT_TRUE(wall.person().placeCamera(4));
  EXPECT_GE(checkMarkers(wall, 4), 3U);
}

TEST(SimulateBoard, EveryCornerIsInThePictureAndTiltsStayModest) {
  for (const Rig& rig : {reportRig(8), miniRig(2)}) {
    for (int index = 0; index < 40; ++index) {
      const BoardPose pose = boardPose(rig.camera, rig.checkerboard, index);
      EXPECT_GT(std::abs(pose.cameraFromBoard[2].z), std::cos(42 * CV_PI / 180)) << index;
      const auto corners = boardCorners(rig.camera, rig.checkerboard, pose);
      ASSERT_EQ(corners.size(), 54U);
      for (const glm::dvec2 corner : corners) {
        EXPECT_TRUE(corner.x > 8 && corner.y > 8 && corner.x < rig.camera.size.width - 8 &&
                    corner.y < rig.camera.size.height - 8)
            << "pose " << index << ": " << corner.x << ", " << corner.y;
      }
    }
  }
}

TEST(SimulateBoard, PosesFillThePicture) {
  const Rig rig = reportRig(8);
  std::set<int> cells;  // of 12 x 8
  for (int index = 0; index < rig.checkerboardPoses; ++index) {
    for (const glm::dvec2 corner :
         boardCorners(rig.camera, rig.checkerboard, boardPose(rig.camera, rig.checkerboard, index))) {
      cells.insert(12 * static_cast<int>(corner.y * 8 / rig.camera.size.height) +
                   static_cast<int>(corner.x * 12 / rig.camera.size.width));
    }
  }
  EXPECT_GE(cells.size(), 80U);
}

TEST(SimulateBoard, ThePersonHasAsManyPosesAsTheRigSays) {
  SimulatedWall wall(miniRig(2));
  EXPECT_TRUE(wall.person().arrange(Scene::kCheckerboard, 14));
  EXPECT_FALSE(wall.person().arrange(Scene::kCheckerboard, 15));
}

/// Cross-check with a detector that knows nothing of this simulator.
TEST(SimulateBoard, CornersAreSeenWhereTheGeometrySays) {
  SimulatedWall wall(reportRig(8));
  for (const int index : {0, 1, 5, 9, 14}) {
    ASSERT_TRUE(wall.person().arrange(Scene::kCheckerboard, index));
    const cv::Mat photo = greyOf(wall.camera().shoot());
    std::vector<cv::Point2f> seen;
    ASSERT_TRUE(cv::findChessboardCorners(photo, {9, 6}, seen)) << index;
    cv::cornerSubPix(photo, seen, {5, 5}, {-1, -1}, {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 40, 0.001});
    const auto& rig = wall.rig();
    const auto truth = boardCorners(rig.camera, rig.checkerboard, boardPose(rig.camera, rig.checkerboard, index));
    double squares = 0;
    glm::dvec2 bias(0);
    for (const cv::Point2f& corner : seen) {
      const glm::dvec2 at(corner.x + 0.5, corner.y + 0.5);
      const auto nearest =
          std::ranges::min_element(truth, {}, [at](glm::dvec2 point) { return glm::distance(at, point); });
      squares += glm::dot(at - *nearest, at - *nearest);
      bias += (at - *nearest) / static_cast<double>(seen.size());
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(seen.size())), 0.07) << index;  // the detector's own scatter
    EXPECT_LT(glm::length(bias), 0.015) << index;
  }
}

}  // namespace
}  // namespace pixelflex::calib
