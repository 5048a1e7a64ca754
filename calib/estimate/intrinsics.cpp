#include "calib/estimate/intrinsics.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace pixelflex::calib {
namespace {

// OpenCV puts pixel centres on whole numbers, the store at +0.5.
constexpr double kHalfPixel = 0.5;

double smallestSpacing(const std::vector<cv::Point2f>& corners, int columns) {
  double smallest = 1e9;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    if ((i + 1) % static_cast<std::size_t>(columns) == 0) continue;
    smallest = std::min(smallest, cv::norm(corners[i + 1] - corners[i]));
  }
  return smallest;
}

/// The board's corners, roughly, in a grey picture; empty when it is not seen whole. Searched in a picture of moderate
/// size, where blur and noise are averaged out and a cluttered picture does not take minutes; a small board far away is
/// then looked for at full size by the second detector, which is slower but bounded.
std::vector<cv::Point2f> searchBoard(const cv::Mat& grey, const Checkerboard& board) {
  constexpr double kModerate = 1000;  // pixels on the longer side
  constexpr int kFlags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  const cv::Size pattern(board.columns, board.rows);
  const double scale = std::min(1.0, kModerate / std::max(grey.cols, grey.rows));
  cv::Mat moderate;
  cv::resize(grey, moderate, {}, scale, scale, cv::INTER_AREA);
  std::vector<cv::Point2f> corners;
  if (cv::findChessboardCorners(moderate, pattern, corners, kFlags)) {
    for (auto& corner : corners) {
      corner.x = static_cast<float>((corner.x + kHalfPixel) / scale - kHalfPixel);
      corner.y = static_cast<float>((corner.y + kHalfPixel) / scale - kHalfPixel);
    }
    return corners;
  }
  if (!cv::findChessboardCornersSB(grey, pattern, corners, cv::CALIB_CB_NORMALIZE_IMAGE)) return {};
  return corners;
}

struct Solution {
  double rms = 0;
  cv::Mat matrix;
  cv::Mat distortion;
  std::vector<double> perView;
};

Solution solve(std::span<const CheckerboardView> views, const Checkerboard& board, devices::Size size) {
  std::vector<cv::Point3f> boardPoints;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      boardPoints.emplace_back(float(column * board.square), float(row * board.square), 0.F);
    }
  }
  std::vector<std::vector<cv::Point2f>> image;
  for (const auto& view : views) {
    auto& points = image.emplace_back();
    for (const auto& corner : view.corners) {
      points.emplace_back(float(corner.x - kHalfPixel), float(corner.y - kHalfPixel));
    }
  }
  const std::vector<std::vector<cv::Point3f>> object(image.size(), boardPoints);
  Solution solution;
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  cv::Mat perView;
  solution.rms = cv::calibrateCamera(object, image, {size.width, size.height}, solution.matrix, solution.distortion,
                                     rotations, translations, cv::noArray(), cv::noArray(), perView, 0,
                                     cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-9));
  for (int i = 0; i < perView.rows; ++i) solution.perView.push_back(perView.at<double>(i));
  return solution;
}

std::vector<CheckerboardView> withoutOutliers(std::span<const CheckerboardView> views,
                                              const std::vector<double>& perView) {
  std::vector<double> sorted = perView;
  std::ranges::sort(sorted);
  const double limit = 3 * std::max(0.05, sorted[sorted.size() / 2]);
  std::vector<CheckerboardView> kept;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (perView[i] <= limit) kept.push_back(views[i]);
  }
  return kept;
}

CameraIntrinsics intrinsicsOf(const Solution& solution, devices::Size size, std::size_t photos) {
  const auto k = [&](int i) { return solution.distortion.at<double>(i); };  // k1 k2 p1 p2 k3
  const auto& m = solution.matrix;
  CameraIntrinsics camera{.size = size,
                          .fx = m.at<double>(0, 0),
                          .fy = m.at<double>(1, 1),
                          .cx = m.at<double>(0, 2) + kHalfPixel,
                          .cy = m.at<double>(1, 2) + kHalfPixel,
                          .radial = {k(0), k(1), k(4)},
                          .tangential = {k(2), k(3)},
                          .rmsPx = solution.rms,
                          .photos = static_cast<int>(photos)};
  const bool sane = std::isfinite(camera.fx) && camera.fx > 0.1 * size.width && camera.fx < 100.0 * size.width &&
                    camera.cx > 0 && camera.cy > 0 && camera.cx < size.width && camera.cy < size.height;
  if (!sane) {
    throw EstimateError(
        "the checkerboard photographs do not determine the camera: tilt the board up to 40 degrees in different "
        "directions and fill the corners of the picture");
  }
  return camera;
}

}  // namespace

std::optional<std::vector<glm::dvec2>> findCheckerboard(const devices::Image8& photo, const Checkerboard& board) {
  const cv::Mat rgb(photo.height(), photo.width(), CV_8UC3, const_cast<std::uint8_t*>(photo.samples().data()));
  cv::Mat grey;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  std::vector<cv::Point2f> corners = searchBoard(grey, board);
  if (corners.empty()) return std::nullopt;
  // A window that reaches the neighbouring corner is worse than a small one (calibration reference 7).
  const int window = std::clamp(static_cast<int>(0.35 * smallestSpacing(corners, board.columns)), 2, 11);
  cv::cornerSubPix(grey, corners, {window, window}, {-1, -1},
                   cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 60, 1e-4));
  std::vector<glm::dvec2> result;
  for (const auto& corner : corners) result.emplace_back(corner.x + kHalfPixel, corner.y + kHalfPixel);
  return result;
}

CameraIntrinsics calibrateCamera(std::span<const CheckerboardView> views, const Checkerboard& board,
                                 devices::Size size) {
  constexpr std::size_t kFewestViews = 3;
  const auto tooFew = [](std::size_t count) {
    return EstimateError("the checkerboard was found in " + std::to_string(count) +
                         " photographs; at least 3 are needed and about 15 advised");
  };
  if (views.size() < kFewestViews) throw tooFew(views.size());
  try {
    const Solution first = solve(views, board, size);
    const auto kept = withoutOutliers(views, first.perView);
    if (kept.size() < kFewestViews) throw tooFew(kept.size());
    if (kept.size() == views.size()) return intrinsicsOf(first, size, views.size());
    return intrinsicsOf(solve(kept, board, size), size, kept.size());
  } catch (const cv::Exception& error) {
    throw EstimateError("the camera cannot be calibrated from these photographs: " + error.err);
  }
}

}  // namespace pixelflex::calib
