#include "calib/estimate/bent_screen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "calib/estimate/lens_solver.h"
#include "calib/estimate/pinhole_fit.h"
#include "calib/geometry/screen_view.h"

namespace pixelflex::calib {
namespace {

/// A bend that lowers the error to less than this part of a plane's is taken for real.
constexpr double kMuchBetter = 0.5;

cv::Point3d lifted(glm::dvec2 pointInWall, double radius, double apex) {
  const double t = (pointInWall.x - apex) / radius;
  return {apex + radius * std::sin(t), pointInWall.y, radius * (std::cos(t) - 1)};
}

SurfaceFit surfaceOf(const cv::Matx33d& k, const cv::Mat& rotationVector, const cv::Mat& translation, double radius,
                     double apex) {
  cv::Matx33d rotation;
  cv::Rodrigues(rotationVector, rotation);
  const cv::Vec3d t(translation.at<double>(0), translation.at<double>(1), translation.at<double>(2));
  cv::Matx33d imageFromPlane;
  for (int row = 0; row < 3; ++row) {
    imageFromPlane(row, 0) = rotation(row, 0);
    imageFromPlane(row, 1) = rotation(row, 1);
    imageFromPlane(row, 2) = t(row);
  }
  const cv::Matx33d wallFromCamera = (k * imageFromPlane).inv();
  const cv::Vec3d depth = k * cv::Vec3d(rotation(0, 2), rotation(1, 2), rotation(2, 2));
  SurfaceFit fit;
  std::copy_n(wallFromCamera.val, 9, fit.wallFromCamera.begin());
  fit.bend = Bend{radius, apex, {depth(0), depth(1), depth(2)}};
  return fit;
}

double rmsOf(const SurfaceFit& surface, std::span<const PointPair> fiducials) {
  const ScreenView view(surface);
  double squares = 0;
  for (const auto& pair : fiducials) {
    const glm::dvec2 off = view.wallFromImage(pair.source).value_or(glm::dvec2(1e9)) - pair.target;
    squares += glm::dot(off, off);
  }
  return std::sqrt(squares / static_cast<double>(fiducials.size()));
}

double widthOf(std::span<const PointPair> pairs) {
  const auto [low, high] = std::ranges::minmax(pairs, {}, [](const PointPair& pair) { return pair.target.x; });
  return high.target.x - low.target.x;
}

/// The curvature, as the bow's part of the width, with the least error: a scan, then golden section around its best.
double bestCurvature(const std::function<double(double)>& error) {
  constexpr std::array kScan{-0.1, -0.05, -0.025, -0.012, -0.006, 0.006, 0.012, 0.025, 0.05, 0.1};
  const double best = *std::ranges::min_element(kScan, {}, error);
  double low = best > 0 ? best / 2.2 : best * 2.2;
  double high = best > 0 ? best * 2.2 : best / 2.2;
  constexpr double kGolden = 0.618033988749895;
  for (int i = 0; i < 14; ++i) {
    const double a = high - kGolden * (high - low);
    const double b = low + kGolden * (high - low);
    const bool left = error(a) < error(b);
    (left ? high : low) = left ? b : a;
  }
  return 0.5 * (low + high);
}

/// The bow of an arc is width^2 / 8 radius.
double radiusOf(double curvature, double width) {
  return width / (8 * curvature);
}

std::optional<std::vector<Sample>> samplesOn(const SurfaceFit& surface, std::span<const PointPair> points) {
  const ScreenView view(surface);
  std::vector<Sample> samples;
  for (const auto& point : points) {
    const auto inWall = view.wallFromImage(point.target);
    if (!inWall) return std::nullopt;
    samples.push_back({point.source, *inWall});
  }
  return samples;
}

/// How badly the points fit any physical projector, if the screen bends like this. Projector pixels.
double bentError(std::span<const PointPair> points, devices::Size resolution, const SurfaceFit& surface) {
  constexpr double kNone = 1e6;
  const auto samples = samplesOn(surface, points);
  if (!samples || !surface.bend) return kNone;
  const auto [radius, apex] = BentScreen{surface.bend->radius, surface.bend->apex};
  try {
    LensSolver solver(*samples, resolution, BentScreen{radius, apex});
    solver.solve();
    std::vector<PointOnScreen> onScreen;
    for (const auto& sample : *samples) {
      const cv::Point3d p = lifted(sample.pointInWall, radius, apex);
      onScreen.push_back({{p.x, p.y, p.z}, sample.pointInProjector});
    }
    return pinholeError(onScreen, solver.model()).value_or(kNone);
  } catch (const EstimateError&) {
    return kNone;
  }
}

}  // namespace

SurfaceFit fitBentSurface(std::span<const PointPair> fiducials, const CameraIntrinsics& camera, double radius) {
  if (fiducials.size() < 4) throw EstimateError("fewer than four fiducials found");
  double apex = 0;
  for (const auto& pair : fiducials) apex += pair.target.x / static_cast<double>(fiducials.size());
  std::vector<cv::Point3d> object;
  std::vector<cv::Point2d> image;
  for (const auto& pair : fiducials) {
    object.push_back(lifted(pair.target, radius, apex));
    image.emplace_back(pair.source.x, pair.source.y);
  }
  const cv::Matx33d k(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::Mat rotation;
  cv::Mat translation;
  try {
    if (!cv::solvePnP(object, image, k, cv::noArray(), rotation, translation, false, cv::SOLVEPNP_SQPNP)) {
      throw EstimateError("the fiducials do not determine where the camera stands");
    }
    cv::solvePnPRefineLM(object, image, k, cv::noArray(), rotation, translation);
  } catch (const cv::Exception& error) {
    throw EstimateError("the fiducials do not determine where the camera stands: " + error.err);
  }
  SurfaceFit fit = surfaceOf(k, rotation, translation, radius, apex);
  fit.rms = rmsOf(fit, fiducials);
  return fit;
}

SurfaceFit fitCylinder(std::span<const PointPair> fiducials, const CameraIntrinsics& camera, double radius) {
  const SurfaceFit hollow = fitBentSurface(fiducials, camera, radius);
  const SurfaceFit bulging = fitBentSurface(fiducials, camera, -radius);
  return hollow.rms <= bulging.rms ? hollow : bulging;
}

std::optional<Bow> bowOfFiducials(std::span<const PointPair> fiducials, const CameraIntrinsics& camera) {
  constexpr std::size_t kFewest = 6;
  if (fiducials.size() < kFewest) return std::nullopt;
  const double width = widthOf(fiducials);
  const auto error = [&](double curvature) {
    return fitBentSurface(fiducials, camera, radiusOf(curvature, width)).rms;
  };
  const double flat = rmsError(solveCollineation(fiducials), fiducials);
  const double curvature = bestCurvature(error);
  const double bent = error(curvature);
  if (bent > kMuchBetter * flat) return std::nullopt;
  return Bow{radiusOf(curvature, width), width, curvature * width, flat, bent};
}

std::optional<Bow> bowOfProjector(std::span<const PointPair> points, devices::Size resolution,
                                  std::span<const PointPair> fiducials, const CameraIntrinsics& camera) {
  if (fiducials.size() < 4 || points.empty()) return std::nullopt;
  // A bow shows in a hundred points as well as in thousands.
  constexpr std::size_t kEnough = 100;
  std::vector<PointPair> few;
  for (std::size_t i = 0; i < points.size(); i += std::max(std::size_t{1}, points.size() / kEnough)) {
    few.push_back(points[i]);
  }
  SurfaceFit plane;
  plane.wallFromCamera = solveCollineation(fiducials).rowMajor();
  const auto samples = samplesOn(plane, few);
  if (!samples) return std::nullopt;
  LensSolver flat(*samples, resolution, std::nullopt);
  flat.solve();
  const double flatError = flat.medianError();
  const auto [low, high] = std::ranges::minmax(*samples, {}, [](const Sample& s) { return s.pointInWall.x; });
  const double width = high.pointInWall.x - low.pointInWall.x;
  const auto error = [&](double curvature) {
    return bentError(few, resolution, fitBentSurface(fiducials, camera, radiusOf(curvature, width)));
  };
  const double curvature = bestCurvature(error);
  const double bent = error(curvature);
  if (bent > kMuchBetter * flatError) return std::nullopt;
  return Bow{radiusOf(curvature, width), width, curvature * width, flatError, bent};
}

}  // namespace pixelflex::calib
