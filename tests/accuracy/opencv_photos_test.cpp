#include <gmock/gmock.h>

#include <filesystem>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/estimate/intrinsics.h"
#include "devices/image/photo_file.h"

// The thirteen left photographs of OpenCV's stereo example and what its authors published in left_intrinsics.yml.

namespace pixelflex::calib {
namespace {

const Checkerboard kBoard{.columns = 9, .rows = 6, .square = 25};

std::vector<devices::Image8> photographs() {
  std::vector<devices::Image8> photos;
  for (const char* number : {"01", "02", "03", "04", "05", "06", "07", "08", "09", "11", "12", "13", "14"}) {
    photos.push_back(
        devices::readPhoto(std::filesystem::path(PIXELFLEX_OPENCV_PHOTOS) / (std::string("left") + number + ".jpg")));
  }
  return photos;
}

/// Corners as OpenCV's calibration example finds them.
std::vector<cv::Point2f> publishedCorners(devices::Image8& photo) {
  const cv::Mat rgb(photo.height(), photo.width(), CV_8UC3, photo.samples().data());
  cv::Mat grey;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  std::vector<cv::Point2f> corners;
  constexpr int kFlags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_FAST_CHECK | cv::CALIB_CB_NORMALIZE_IMAGE;
  EXPECT_TRUE(cv::findChessboardCorners(grey, {kBoard.columns, kBoard.rows}, corners, kFlags));
  cv::cornerSubPix(grey, corners, {11, 11}, {-1, -1},
                   cv::TermCriteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 30, 0.1));
  return corners;
}

TEST(OpenCvPhotographs, ReproduceWhatWasPublished) {
  std::vector<cv::Point3f> board;
  for (int i = 0; i < kBoard.columns * kBoard.rows; ++i) {
    board.emplace_back(0.025F * static_cast<float>(i % kBoard.columns), 0.025F * static_cast<float>(i / kBoard.columns),
                       0.F);
  }
  std::vector<std::vector<cv::Point2f>> corners;
  for (auto& photo : photographs()) corners.push_back(publishedCorners(photo));
  const std::vector<std::vector<cv::Point3f>> boards(corners.size(), board);
  cv::Mat matrix = cv::Mat::eye(3, 3, CV_64F);
  cv::Mat lens;
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  const double rms = cv::calibrateCamera(boards, corners, {640, 480}, matrix, lens, rotations, translations,
                                         cv::CALIB_FIX_ASPECT_RATIO);
  EXPECT_NEAR(rms, 0.392591, 1e-4);
  EXPECT_NEAR(matrix.at<double>(0, 0), 535.9157, 0.01);
  EXPECT_NEAR(matrix.at<double>(0, 2), 342.2832, 0.01);
  EXPECT_NEAR(matrix.at<double>(1, 2), 235.5708, 0.01);
  EXPECT_NEAR(lens.at<double>(0), -0.26637, 1e-4);
  EXPECT_NEAR(lens.at<double>(4), 0.23839, 1e-3);
}

TEST(OpenCvPhotographs, AreCalibratedBetterThanWhatWasPublished) {
  std::vector<CheckerboardView> views;
  for (const auto& photo : photographs()) {
    const auto corners = findCheckerboard(photo, kBoard);
    ASSERT_TRUE(corners) << "photograph " << views.size() + 1;
    views.push_back({std::to_string(views.size() + 1), *corners});
  }
  const CameraIntrinsics camera = calibrateCamera(views, kBoard, {640, 480});
  EXPECT_EQ(camera.photos, 13);  // none is left out
  EXPECT_LT(camera.rmsPx, 0.25);
  // The published camera, whose centre is in OpenCV's coordinates, to what its own error lets one expect.
  EXPECT_NEAR(camera.fx, 535.916, 0.01 * 535.916);
  EXPECT_NEAR(camera.fx / camera.fy, 1, 0.002);
  EXPECT_NEAR(camera.cx, 342.283 + 0.5, 4);
  EXPECT_NEAR(camera.cy, 235.571 + 0.5, 4);
  RecordProperty("rms", std::to_string(camera.rmsPx));
}

}  // namespace
}  // namespace pixelflex::calib
