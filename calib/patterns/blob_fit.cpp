#include "calib/patterns/blob_fit.h"

#include <Eigen/Dense>
#include <cmath>

namespace pixelflex::calib {
namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

GaussianFit fitOf(const Vector5& p, const Matrix5& normal, double cost, std::size_t samples) {
  const Matrix5 covariance = normal.inverse() * (cost / static_cast<double>(samples - 5));
  return {{p[0], p[1]}, p[2], p[3], p[4], std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1)))};
}

/// Sum of squares; also the normal equations when asked for.
double evaluate(std::span<const LightSample> samples, const Vector5& p, Matrix5* normal, Vector5* gradient) {
  double cost = 0;
  if (normal != nullptr) normal->setZero();
  if (gradient != nullptr) gradient->setZero();
  const double inverse = 1 / (p[2] * p[2]);
  for (const auto& sample : samples) {
    const double dx = sample.at.x - p[0];
    const double dy = sample.at.y - p[1];
    const double r2 = dx * dx + dy * dy;
    const double bell = std::exp(-0.5 * r2 * inverse);
    const double residual = p[4] + p[3] * bell - sample.light;
    cost += residual * residual;
    if (normal == nullptr) continue;
    const double slope = p[3] * bell * inverse;
    const Vector5 j(slope * dx, slope * dy, slope * r2 / p[2], bell, 1.0);
    *normal += j * j.transpose();
    *gradient += j * residual;
  }
  return cost;
}

}  // namespace

std::optional<GaussianFit> fitGaussian(std::span<const LightSample> samples, const GaussianFit& start) {
  if (samples.size() < 12) return std::nullopt;
  Vector5 p(start.centre.x, start.centre.y, start.sigma, start.amplitude, start.background);
  Matrix5 normal;
  Vector5 gradient;
  double damping = 1e-3;
  double cost = evaluate(samples, p, &normal, &gradient);
  for (int iteration = 0; iteration < 60; ++iteration) {
    Matrix5 damped = normal;
    damped.diagonal() *= 1 + damping;
    const Vector5 step = damped.ldlt().solve(-gradient);
    const Vector5 candidate = p + step;
    const double newCost = step.allFinite() && candidate[2] > 0 ? evaluate(samples, candidate, nullptr, nullptr) : cost;
    if (newCost < cost) {
      p = candidate;
      damping = std::max(1e-9, damping / 4);
      cost = evaluate(samples, p, &normal, &gradient);
      if (step.head<2>().norm() < 1e-7 * p[2]) return fitOf(p, normal, cost, samples.size());
    } else {
      damping *= 8;
      if (damping > 1e9) break;  // no step helps: this is the minimum
    }
  }
  return damping > 1e9 ? std::optional(fitOf(p, normal, cost, samples.size())) : std::nullopt;
}

}  // namespace pixelflex::calib
