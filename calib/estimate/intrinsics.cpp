#include "calib/estimate/intrinsics.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <tuple>

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
  double focalDeviation = 0;  // standard deviation of the focal length, relative
  double tilts = 0;           // degrees between the two boards whose planes differ most
};

double largestTilt(const std::vector<cv::Mat>& rotations) {
  std::vector<cv::Vec3d> normals;
  for (const auto& rotation : rotations) {
    cv::Matx33d matrix;
    cv::Rodrigues(rotation, matrix);
    normals.emplace_back(matrix(0, 2), matrix(1, 2), matrix(2, 2));
  }
  double least = 1;
  for (const auto& one : normals) {
    for (const auto& other : normals) least = std::min(least, std::abs(one.dot(other)));
  }
  return std::acos(std::min(1.0, least)) * 180 / CV_PI;
}

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
  cv::Mat deviations;
  solution.rms = cv::calibrateCamera(object, image, {size.width, size.height}, solution.matrix, solution.distortion,
                                     rotations, translations, deviations, cv::noArray(), perView, 0,
                                     cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-9));
  for (int i = 0; i < perView.rows; ++i) solution.perView.push_back(perView.at<double>(i));
  solution.focalDeviation = std::max(deviations.at<double>(0) / solution.matrix.at<double>(0, 0),
                                     deviations.at<double>(1) / solution.matrix.at<double>(1, 1));
  solution.tilts = largestTilt(rotations);
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

constexpr const char* kTiltAdvice =
    "tilt the board up to 40 degrees in different directions and fill the corners of the picture";

std::string namesOf(std::span<const CheckerboardView> views) {
  constexpr std::size_t kMost = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, views.size()); ++i) text += (i > 0 ? ", " : "") + views[i].name;
  return views.size() > kMost ? text + ", ..." : text;
}

CameraIntrinsics intrinsicsOf(const Solution& solution, devices::Size size, std::span<const CheckerboardView> views) {
  constexpr double kMostDeviation = 0.02;
  constexpr double kLeastTilt = 6;                                          // degrees
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
                          .photos = static_cast<int>(views.size())};
  const bool sane = std::isfinite(camera.fx) && camera.fx > 0.1 * size.width && camera.fx < 100.0 * size.width &&
                    camera.cx > 0 && camera.cy > 0 && camera.cx < size.width && camera.cy < size.height;
  const bool alike = solution.tilts < kLeastTilt;
  if (sane && !alike && solution.focalDeviation < kMostDeviation) return camera;
  std::string reason = "the checkerboard photographs (" + namesOf(views) + ") do not determine the camera";
  if (alike) {
    reason += ": all show the board at nearly the same tilt, within " +
              std::to_string(static_cast<int>(std::ceil(solution.tilts))) + " degrees";
  } else if (sane) {
    reason += ": its focal length would be uncertain by " +
              std::to_string(static_cast<int>(std::lround(100 * solution.focalDeviation))) + " %";
  }
  throw EstimateError(reason + "; " + kTiltAdvice);
}

/// One view of each place that the board was held in.
std::vector<CheckerboardView> withoutRepetitions(std::span<const CheckerboardView> views, std::string& repeated) {
  constexpr double kSame = 0.3;  // pixels: a camera on a stand and a board on another
  std::vector<CheckerboardView> kept;
  for (const auto& view : views) {
    const auto same = [&](const CheckerboardView& other) {
      double worst = 0;
      for (std::size_t i = 0; i < view.corners.size(); ++i) {
        const glm::dvec2 apart = view.corners[i] - other.corners[i];
        worst = std::max(worst, std::hypot(apart.x, apart.y));
      }
      return worst < kSame;
    };
    const auto known = std::ranges::find_if(kept, same);
    if (known == kept.end()) {
      kept.push_back(view);
    } else {
      repeated += (repeated.empty() ? "" : ", ") + view.name + " like " + known->name;
    }
  }
  return kept;
}

/// Where no board was seen the lens is a guess.
void remarkOnCoverage(std::span<const CheckerboardView> views, devices::Size size, std::vector<std::string>& remarks) {
  constexpr double kCorner = 0.3;  // of the picture's width and height
  std::string missing;
  for (const auto& [name, right, lower] :
       {std::tuple("upper left", false, false), std::tuple("upper right", true, false),
        std::tuple("lower left", false, true), std::tuple("lower right", true, true)}) {
    const bool seen = std::ranges::any_of(views, [&, right = right, lower = lower](const CheckerboardView& view) {
      return std::ranges::any_of(view.corners, [&](glm::dvec2 p) {
        const double x = right ? size.width - p.x : p.x;
        const double y = lower ? size.height - p.y : p.y;
        return x < kCorner * size.width && y < kCorner * size.height;
      });
    });
    if (!seen) missing += (missing.empty() ? "" : ", ") + std::string(name);
  }
  if (missing.empty()) return;
  remarks.push_back("no checkerboard was seen in a corner of the picture (" + missing +
                    "): the lens is a guess there; add photographs that fill it");
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

CameraIntrinsics calibrateCamera(std::span<const CheckerboardView> views, const Checkerboard& board, devices::Size size,
                                 std::vector<std::string>* remarks) {
  constexpr std::size_t kFewestViews = 3;
  constexpr double kUncertain = 0.005;  // of the focal length: said
  std::string repeated;
  const auto distinct = withoutRepetitions(views, repeated);
  if (!repeated.empty()) repeated = "the board is in one and the same place in " + repeated;
  const auto tooFew = [&](std::size_t count) {
    return EstimateError("the checkerboard was found in " + std::to_string(count) +
                         (repeated.empty() ? " photographs" : " different photographs (" + repeated + ")") +
                         "; at least 3 are needed and about 15 advised");
  };
  if (distinct.size() < kFewestViews) throw tooFew(distinct.size());
  try {
    Solution solution = solve(distinct, board, size);
    const auto kept = withoutOutliers(distinct, solution.perView);
    if (kept.size() < kFewestViews) throw tooFew(kept.size());
    if (kept.size() < distinct.size()) solution = solve(kept, board, size);
    const CameraIntrinsics camera = intrinsicsOf(solution, size, kept);
    if (remarks == nullptr) return camera;
    if (!repeated.empty()) remarks->push_back(repeated + "; counted once");
    if (solution.focalDeviation > kUncertain) {
      remarks->push_back("the camera's focal length is uncertain by about " +
                         std::to_string(static_cast<int>(std::lround(1000 * solution.focalDeviation))) +
                         " parts in a thousand: " + kTiltAdvice);
    }
    remarkOnCoverage(kept, size, *remarks);
    return camera;
  } catch (const cv::Exception& error) {
    throw EstimateError("the camera cannot be calibrated from these photographs: " + error.err);
  }
}

}  // namespace pixelflex::calib
