#include "calib/estimate/pinhole_fit.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <vector>

namespace pixelflex::calib {
namespace {

/// Blocks: intrinsics (f, cx, cy, k1, k2; pixels over the model's scale) and pose (angle-axis, translation).
struct PinholeResidual {
  glm::dvec3 onScreen;  // over the unit
  glm::dvec2 inProjector;
  double scale;

  template <class T>
  bool operator()(const T* lens, const T* pose, T* residual) const {
    const T point[3] = {T(onScreen.x), T(onScreen.y), T(onScreen.z)};
    T turned[3];
    ceres::AngleAxisRotatePoint(pose, point, turned);
    const T z = turned[2] + pose[5];
    const T x = (turned[0] + pose[3]) / z;
    const T y = (turned[1] + pose[4]) / z;
    const T r2 = x * x + y * y;
    const T factor = T(1) + r2 * (lens[3] + r2 * lens[4]);
    residual[0] = (lens[0] * factor * x + lens[1]) * scale - inProjector.x;
    residual[1] = (lens[0] * factor * y + lens[2]) * scale - inProjector.y;
    return true;
  }
};

struct Pinhole {
  std::array<double, 5> lens{};
  std::array<double, 6> pose{};
};

/// The fit's own 3x4 matrix taken apart, its skew and unequal focal lengths dropped. Room units over `unit`.
Pinhole startFrom(const ProjectorModel& model, double unit) {
  const auto& h = model.projectorFromWall;
  const auto depth = model.bend ? model.bend->depth : std::array<double, 3>{};
  cv::Matx34d projection(h[0], h[1], depth[0], h[2] / unit, h[3], h[4], depth[1], h[5] / unit, h[6], h[7], depth[2],
                         h[8] / unit);
  cv::Mat k;
  cv::Mat rotation;
  cv::Mat centre;
  cv::decomposeProjectionMatrix(projection, k, rotation, centre);
  k /= k.at<double>(2, 2);
  cv::Mat vector;
  cv::Rodrigues(rotation, vector);
  const cv::Mat position = centre.rowRange(0, 3) / centre.at<double>(3);
  const cv::Mat translation = -rotation * position;
  Pinhole start;
  start.lens = {std::sqrt(std::abs(k.at<double>(0, 0) * k.at<double>(1, 1))),
                k.at<double>(0, 2) + model.centre.x / model.scale, k.at<double>(1, 2) + model.centre.y / model.scale, 0,
                0};
  for (int i = 0; i < 3; ++i) {
    start.pose[static_cast<std::size_t>(i)] = vector.at<double>(i);
    start.pose[static_cast<std::size_t>(i) + 3] = translation.at<double>(i);
  }
  return start;
}

}  // namespace

std::optional<double> pinholeError(std::span<const PointOnScreen> points, const ProjectorModel& start) {
  double unit = 0;
  for (const auto& point : points) unit = std::max({unit, std::abs(point.onScreen.x), std::abs(point.onScreen.y)});
  Pinhole pinhole = startFrom(start, unit);
  ceres::Problem problem;
  for (const auto& point : points) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PinholeResidual, 2, 5, 6>(
                                 new PinholeResidual{point.onScreen / unit, point.inProjector, start.scale}),
                             new ceres::HuberLoss(1), pinhole.lens.data(), pinhole.pose.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable() || !(pinhole.lens[0] > 0)) return std::nullopt;
  std::vector<double> residuals;
  problem.Evaluate({}, nullptr, &residuals, nullptr, nullptr);
  std::vector<double> errors;
  for (std::size_t i = 0; i + 1 < residuals.size(); i += 2) {
    errors.push_back(std::hypot(residuals[i], residuals[i + 1]));
  }
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

}  // namespace pixelflex::calib
