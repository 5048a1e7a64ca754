#include "calib/estimate/fiducials.h"

#include <array>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace pixelflex::calib {
namespace {

glm::dvec2 crossing(const std::array<glm::dvec2, 4>& corner) {
  const glm::dvec2 along = corner[2] - corner[0];
  const glm::dvec2 other = corner[3] - corner[1];
  const glm::dvec2 between = corner[1] - corner[0];
  const double t = (between.x * other.y - between.y * other.x) / (along.x * other.y - along.y * other.x);
  return corner[0] + along * t;
}

}  // namespace

std::map<int, glm::dvec2> findMarkers(const devices::Image8& photo, const CameraMapping& camera) {
  const cv::Mat rgb(photo.height(), photo.width(), CV_8UC3, const_cast<std::uint8_t*>(photo.samples().data()));
  cv::Mat grey;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  parameters->cornerRefinementWinSize = 4;
  parameters->cornerRefinementMaxIterations = 60;
  parameters->cornerRefinementMinAccuracy = 0.01;
  parameters->minMarkerPerimeterRate = 0.01;  // of the picture's larger side: markers of 24 pixels are found
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(grey, dictionary, corners, ids, parameters);
  std::map<int, glm::dvec2> centres;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    std::array<glm::dvec2, 4> undistorted{};
    for (std::size_t k = 0; k < 4; ++k) {
      undistorted[k] = camera.undistortedFromRaw({corners[i][k].x + 0.5, corners[i][k].y + 0.5});
    }
    centres[ids[i]] = crossing(undistorted);
  }
  return centres;
}

}  // namespace pixelflex::calib
