#include "calib/estimate/residual_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "calib/geometry/residual_map.h"

namespace pixelflex::calib {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kWorthIt = 0.9;  // of the error without a correction

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Adds stiffness * |a - 2 b + c|^2 for all neighbouring control points along both axes.
void addBending(MatrixXd& normal, int columns, int rows, double stiffness) {
  const Index across = columns + 3;
  const Index down = rows + 3;
  const std::array<double, 3> difference{1, -2, 1};
  const auto addTriple = [&](Index first, Index step) {
    for (Index i = 0; i < 3; ++i) {
      for (Index j = 0; j < 3; ++j) {
        normal(first + i * step, first + j * step) +=
            stiffness * difference[static_cast<std::size_t>(i)] * difference[static_cast<std::size_t>(j)];
      }
    }
  };
  for (Index y = 0; y < down; ++y) {
    for (Index x = 0; x < across; ++x) {
      if (x + 2 < across) addTriple(y * across + x, 1);
      if (y + 2 < down) addTriple(y * across + x, across);
    }
  }
}

class SplineSystem {
 public:
  SplineSystem(std::span<const ResidualSample> samples, const ResidualChoice& choice, devices::Size resolution)
      : samples_(samples), choice_(choice), spline_{choice.columns, choice.rows, {}} {
    for (const auto& sample : samples) {
      supports_.push_back(ResidualMap::supportOf(spline_, resolution, sample.at));
    }
    spline_.control.resize(static_cast<std::size_t>(choice.columns + 3) * static_cast<std::size_t>(choice.rows + 3));
  }

  ResidualSpline fit(int leftOut) {
    constexpr double kOutlier = 4;  // times the median error
    solve(leftOut, 1e300);
    std::vector<double> errors;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (samples_[i].fold != leftOut) errors.push_back(error(i));
    }
    solve(leftOut, std::max(kOutlier * median(errors), 1e-3));
    return spline_;
  }

  [[nodiscard]] double error(std::size_t sample) const {
    glm::dvec2 value{0, 0};
    for (std::size_t k = 0; k < 16; ++k) {
      value += supports_[sample].weight[k] * spline_.control[supports_[sample].index[k]];
    }
    return glm::length(samples_[sample].residual - value);
  }

 private:
  void solve(int leftOut, double largest) {
    const auto size = static_cast<Index>(spline_.control.size());
    MatrixXd normal = MatrixXd::Identity(size, size) * 1e-9;
    MatrixXd right = MatrixXd::Zero(size, 2);
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (samples_[i].fold == leftOut || (largest < 1e300 && error(i) > largest)) continue;
      addSample(i, normal, right);
    }
    addBending(normal, choice_.columns, choice_.rows, choice_.stiffness);
    const MatrixXd control = normal.ldlt().solve(right);
    for (Index i = 0; i < size; ++i) spline_.control[static_cast<std::size_t>(i)] = {control(i, 0), control(i, 1)};
  }

  void addSample(std::size_t i, MatrixXd& normal, MatrixXd& right) const {
    const auto& [index, weight] = supports_[i];
    for (std::size_t a = 0; a < 16; ++a) {
      const auto row = static_cast<Index>(index[a]);
      right(row, 0) += weight[a] * samples_[i].residual.x;
      right(row, 1) += weight[a] * samples_[i].residual.y;
      for (std::size_t b = 0; b < 16; ++b) normal(row, static_cast<Index>(index[b])) += weight[a] * weight[b];
    }
  }

  std::span<const ResidualSample> samples_;
  ResidualChoice choice_;
  ResidualSpline spline_;
  std::vector<ResidualMap::Support> supports_;
};

/// Root mean square in which outliers count as ten times the median: borders must decide, wild samples must not.
double typical(const std::vector<double>& errors) {
  const double limit = 10 * median(errors);
  double squares = 0;
  for (const double error : errors) squares += std::min(error, limit) * std::min(error, limit);
  return errors.empty() ? 0 : std::sqrt(squares / static_cast<double>(errors.size()));
}

double heldOutError(std::span<const ResidualSample> samples, const ResidualChoice& choice, devices::Size resolution) {
  SplineSystem system(samples, choice, resolution);
  std::vector<double> errors;
  for (int fold = 0; fold < kFolds; ++fold) {
    (void)system.fit(fold);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (samples[i].fold == fold) errors.push_back(system.error(i));
    }
  }
  return typical(errors);
}

}  // namespace

std::optional<ResidualChoice> chooseResidual(std::span<const ResidualSample> samples, devices::Size resolution) {
  constexpr std::array kColumns{2, 4, 6, 10, 16};
  constexpr std::array kStiffness{1e-3, 0.1, 10.0};
  std::vector<double> plain;
  for (const auto& sample : samples) plain.push_back(glm::length(sample.residual));
  double best = kWorthIt * typical(plain);
  std::optional<ResidualChoice> chosen;
  for (const int columns : kColumns) {
    const int rows = std::max(2, static_cast<int>(std::lround(double(columns) * resolution.height / resolution.width)));
    if (static_cast<std::size_t>(columns + 3) * static_cast<std::size_t>(rows + 3) > samples.size()) break;
    for (const double stiffness : kStiffness) {
      const ResidualChoice choice{columns, rows, stiffness};
      const double error = heldOutError(samples, choice, resolution);
      if (error >= best) continue;
      // A finer spline must earn its place.
      best = 0.98 * error;
      chosen = choice;
    }
  }
  return chosen;
}

ResidualSpline fitResidual(std::span<const ResidualSample> samples, const ResidualChoice& choice,
                           devices::Size resolution, int leftOut) {
  return SplineSystem(samples, choice, resolution).fit(leftOut);
}

}  // namespace pixelflex::calib
