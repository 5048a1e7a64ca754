#include "calib/patterns/dense_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pixelflex::calib {
namespace {

constexpr std::size_t kFewestPairs = 24;
constexpr double kMostLeverage = 1.0;     // variance of the fit at the point, in those of one pixel
constexpr double kFarOut = 4;             // robust deviations
constexpr double kLeastDeviation = 0.01;  // camera pixels: noise alone never makes outliers of good pixels
constexpr int kRounds = 6;

using Terms = Eigen::Matrix<double, 6, 1>;
using Coefficients = Eigen::Matrix<double, 6, 2>;

Terms termsOf(glm::dvec2 p) {
  return (Terms() << 1, p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y).finished();
}

class LocalFit {
 public:
  LocalFit(glm::dvec2 centre, double reach, const std::vector<DensePair>& pairs)
      : centre_(centre), reach_(reach), pairs_(pairs) {}

  /// False when the pairs do not determine the quadratic at the centre.
  bool solve() {
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Coefficients right = Coefficients::Zero();
    const glm::dvec2 origin = pairs_.front().pointInUndistorted;  // keeps the numbers small
    for (const auto& pair : pairs_) {
      const Terms terms = termsOf((pair.pointInProjector - centre_) / reach_);
      const glm::dvec2 target = pair.pointInUndistorted - origin;
      normal.noalias() += terms * terms.transpose();
      right.noalias() += terms * Eigen::RowVector2d(target.x, target.y);
    }
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factors(normal);
    if (factors.info() != Eigen::Success || factors.rcond() < 1e-9) return false;
    coefficients_ = factors.solve(right);
    coefficients_.row(0) += Eigen::RowVector2d(origin.x, origin.y);
    leverage_ = factors.solve(Terms::Unit(0))[0];
    return coefficients_.allFinite();
  }

  [[nodiscard]] double leverage() const { return leverage_; }
  [[nodiscard]] double residual(const DensePair& pair) const {
    const Eigen::RowVector2d at = termsOf((pair.pointInProjector - centre_) / reach_).transpose() * coefficients_;
    return std::hypot(at[0] - pair.pointInUndistorted.x, at[1] - pair.pointInUndistorted.y);
  }
  [[nodiscard]] LocalMap map() const {
    const auto row = [this](int i) { return glm::dvec2(coefficients_(i, 0), coefficients_(i, 1)); };
    return {row(0), row(1) / reach_, row(2) / reach_};
  }

 private:
  glm::dvec2 centre_;
  double reach_;
  const std::vector<DensePair>& pairs_;
  Coefficients coefficients_ = Coefficients::Zero();
  double leverage_ = 0;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Whether any pair was left out.
bool dropOutliers(std::vector<DensePair>& pairs, const LocalFit& fit) {
  std::vector<double> residuals;
  residuals.reserve(pairs.size());
  for (const auto& pair : pairs) residuals.push_back(fit.residual(pair));
  const double most = kFarOut * std::max(kLeastDeviation, median(residuals) / 1.1774);  // Rayleigh's median
  const std::size_t before = pairs.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < before; ++i) {
    if (residuals[i] <= most) pairs[kept++] = pairs[i];
  }
  pairs.resize(kept);
  return kept < before;
}

}  // namespace

std::optional<LocalMap> fitAround(glm::dvec2 pointInProjector, double reach, std::vector<DensePair> pairs) {
  const std::size_t fewest = std::max(kFewestPairs, pairs.size() / 2);  // a minority proves nothing
  for (int round = 1; pairs.size() >= fewest; ++round) {
    LocalFit fit(pointInProjector, reach, pairs);
    if (!fit.solve()) return std::nullopt;
    const LocalMap map = fit.map();
    const bool sure = fit.leverage() <= kMostLeverage;
    if (round == kRounds || !dropOutliers(pairs, fit)) return sure ? std::optional(map) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace pixelflex::calib
