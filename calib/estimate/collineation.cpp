#include "calib/estimate/collineation.h"

#include <Eigen/Dense>
#include <cmath>
#include <glm/geometric.hpp>

namespace pixelflex::calib {
namespace {

/// Moves points to mean zero and unit spread.
Homography normaliser(std::span<const PointPair> pairs, glm::dvec2 PointPair::*which) {
  glm::dvec2 mean{0, 0};
  for (const auto& pair : pairs) mean += pair.*which;
  mean /= static_cast<double>(pairs.size());
  double spread = 0;
  for (const auto& pair : pairs) spread += glm::length(pair.*which - mean);
  spread /= static_cast<double>(pairs.size());
  if (!(spread > 0) || !std::isfinite(spread)) throw EstimateError("the reference points all lie in one place");
  return Homography::scaling(glm::dvec2(1 / spread)) * Homography::translation(-mean);
}

/// The null vector of the homogeneous form of equation 4, two rows a pair.
Homography solveNormalised(const std::vector<PointPair>& pairs) {
  Eigen::MatrixXd f(2 * static_cast<Eigen::Index>(pairs.size()), 9);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [x, y] = std::pair(pairs[i].source.x, pairs[i].source.y);
    const auto [u, v] = std::pair(pairs[i].target.x, pairs[i].target.y);
    const auto row = 2 * static_cast<Eigen::Index>(i);
    f.row(row) << x, y, 1, 0, 0, 0, -u * x, -u * y, -u;
    f.row(row + 1) << 0, 0, 0, x, y, 1, -v * x, -v * y, -v;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(f, Eigen::ComputeFullV);
  const auto& singular = svd.singularValues();
  if (singular[7] < 1e-7 * singular[0]) {
    throw EstimateError("the reference points do not determine the wall: at least four, no three of them on a line");
  }
  std::array<double, 9> h{};
  for (std::size_t i = 0; i < 9; ++i) h[i] = svd.matrixV()(static_cast<Eigen::Index>(i), 8);
  return Homography(h);
}

/// Gauss-Newton on the target error, which the algebraic solution only approximates for more than four pairs.
Homography polish(Homography start, const std::vector<PointPair>& pairs) {
  std::array<double, 9> h = start.rowMajor();
  for (double& value : h) value /= start.rowMajor()[8];
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Homography current(h);
    Eigen::Matrix<double, 8, 8> normal = Eigen::Matrix<double, 8, 8>::Zero();
    Eigen::Matrix<double, 8, 1> gradient = Eigen::Matrix<double, 8, 1>::Zero();
    for (const auto& pair : pairs) {
      const double w = current.weight(pair.source);
      const glm::dvec2 mapped = current.map(pair.source);
      const glm::dvec2 error = mapped - pair.target;
      const double x = pair.source.x / w;
      const double y = pair.source.y / w;
      Eigen::Matrix<double, 2, 8> j;
      j << x, y, 1 / w, 0, 0, 0, -mapped.x * x, -mapped.x * y, 0, 0, 0, x, y, 1 / w, -mapped.y * x, -mapped.y * y;
      normal += j.transpose() * j;
      gradient += j.transpose() * Eigen::Vector2d(error.x, error.y);
    }
    const Eigen::Matrix<double, 8, 1> step = normal.ldlt().solve(-gradient);
    if (!step.allFinite()) break;
    for (std::size_t i = 0; i < 8; ++i) h[i] += step[static_cast<Eigen::Index>(i)];
    if (step.norm() < 1e-14) break;
  }
  return Homography(h);
}

}  // namespace

Homography solveCollineation(std::span<const PointPair> pairs) {
  if (pairs.size() < 4) {
    throw EstimateError("fewer than four fiducials: " + std::to_string(pairs.size()) +
                        " usable, and the collineation needs at least four");
  }
  const Homography source = normaliser(pairs, &PointPair::source);
  const Homography target = normaliser(pairs, &PointPair::target);
  std::vector<PointPair> normalised;
  for (const auto& pair : pairs) normalised.push_back({source.map(pair.source), target.map(pair.target)});
  Homography solution = solveNormalised(normalised);
  // Dividing by h33 is safe once the sources' mean is the origin: h33 = 0 would put that mean on the horizon.
  if (pairs.size() > 4 && std::abs(solution.rowMajor()[8]) > 1e-9) solution = polish(solution, normalised);
  return target.inverse() * solution * source;
}

double rmsError(const Homography& targetFromSource, std::span<const PointPair> pairs) {
  double sum = 0;
  for (const auto& pair : pairs) {
    const glm::dvec2 error = targetFromSource.map(pair.source) - pair.target;
    sum += glm::dot(error, error);
  }
  return pairs.empty() ? 0 : std::sqrt(sum / static_cast<double>(pairs.size()));
}

}  // namespace pixelflex::calib
