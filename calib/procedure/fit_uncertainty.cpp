#include "calib/procedure/fit_uncertainty.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace pixelflex::calib {
namespace {

/// Unknowns that a homography and a lens really have: of Brown's, the higher ones hardly show.
constexpr double kLensUnknowns = 12;

/// Numbers that the model was fitted with.
double unknownsOf(const ProjectorModel& model) {
  if (!model.residual) return kLensUnknowns;
  return kLensUnknowns + 2.0 * (model.residual->columns + 3) * (model.residual->rows + 3);
}

}  // namespace

FitUncertainty::FitUncertainty(const ProjectorCalibration& projector)
    : mapping_(projector.model, projector.resolution) {
  measureResiduals(projector);
  const double numbers = 2 * static_cast<double>(residuals_.size());
  const double unknowns = unknownsOf(projector.model);
  if (projector.flatAt || numbers <= unknowns + 1) return;
  const double squares = projector.quality.rms * projector.quality.rms;
  const double deviation = projector.quality.deviation;
  sampleVariance_ = std::min(squares * numbers / (numbers - unknowns), neighbourVariance());
  // The deviation is that of the lens alone: where a spline follows what the lens leaves, it says too much.
  const bool known = deviation > 0 && !projector.model.residual;
  modelVariance_ = known ? deviation * deviation : squares * unknowns / (numbers - unknowns);
  spacing_ = std::sqrt(static_cast<double>(projector.resolution.area()) / static_cast<double>(residuals_.size()));
  learnLeverage();
}

void FitUncertainty::measureResiduals(const ProjectorCalibration& projector) {
  for (const auto& sample : projector.samples) {
    const auto modelled = mapping_.wallFromProjector(sample.pointInProjector);
    if (modelled) residuals_.push_back({sample.pointInProjector, *modelled - sample.pointInWall});
  }
}

/// Half the mean square of what nearest neighbours differ by: the noise alone, where the model's own error is smooth.
double FitUncertainty::neighbourVariance() const {
  double sum = 0;
  for (const auto& own : residuals_) {
    const Residual* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& other : residuals_) {
      const glm::dvec2 away = other.inProjector - own.inProjector;
      const double distance2 = glm::dot(away, away);
      if (&other == &own || distance2 >= least) continue;
      least = distance2;
      nearest = &other;
    }
    if (nearest == nullptr) return least;
    const glm::dvec2 difference = (nearest->inWall - own.inWall) * mapping_.density(own.inProjector);
    sum += glm::dot(difference, difference) / 2;
  }
  return sum / static_cast<double>(residuals_.size());
}

FitUncertainty::Terms FitUncertainty::terms(glm::dvec2 p) const {
  const glm::dvec2 half = glm::dvec2(mapping_.resolution().width, mapping_.resolution().height) / 2.0;
  const double x = p.x / half.x - 1;
  const double y = p.y / half.y - 1;
  return {1, x, y, x * x, x * y, y * y};
}

void FitUncertainty::learnLeverage() {
  using Matrix = Eigen::Matrix<double, kTerms, kTerms, Eigen::RowMajor>;
  Matrix normal = Matrix::Zero();
  for (const auto& residual : residuals_) {
    const Terms t = terms(residual.inProjector);
    const Eigen::Map<const Eigen::Matrix<double, kTerms, 1>> v(t.data());
    normal += v * v.transpose();
  }
  const Eigen::FullPivLU<Matrix> solver(normal);
  if (!solver.isInvertible()) return;
  Eigen::Map<Matrix>(inverseNormal_.data()) = solver.inverse();
  // Over the same lattice, border included, as the deviation.
  constexpr int kSteps = 5;
  const glm::dvec2 step = glm::dvec2(mapping_.resolution().width, mapping_.resolution().height) / double{kSteps - 1};
  for (int i = 0; i < kSteps * kSteps; ++i) {
    meanLeverage_ += leverage(step * glm::dvec2(i % kSteps, static_cast<int>(i / kSteps))) / (kSteps * kSteps);
  }
}

double FitUncertainty::leverage(glm::dvec2 pointInProjector) const {
  const Terms t = terms(pointInProjector);
  double sum = 0;
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t j = 0; j < kTerms; ++j) sum += t[i] * inverseNormal_[i * kTerms + j] * t[j];
  }
  return sum;
}

void FitUncertainty::addWindow(glm::dvec2 p, Local& local) const {
  const double width = 0.75 * spacing_;
  double sum = 0, squares = 0;
  glm::dvec2 weighted{0, 0};
  for (const auto& residual : residuals_) {
    const glm::dvec2 away = residual.inProjector - p;
    const double distance2 = glm::dot(away, away) / (width * width);
    if (distance2 > 9) continue;
    const double weight = std::exp(-distance2 / 2);
    sum += weight, squares += weight * weight, weighted += weight * residual.inWall;
  }
  if (sum < 0.1) return;  // no sample near enough to say anything
  local.meanResidual = weighted / sum;
  local.meanVariance = sampleVariance_ * squares / (sum * sum);
}

std::optional<FitUncertainty::Local> FitUncertainty::at(glm::dvec2 pointInWall) const {
  const auto p = mapping_.projectorFromWall(pointInWall);
  if (!p) return std::nullopt;
  const double density = mapping_.density(*p);
  if (!(density > 0)) return std::nullopt;
  Local local;
  if (modelVariance_ <= 0) return local;
  addWindow(*p, local);
  const double spread = meanLeverage_ > 0 ? leverage(*p) / meanLeverage_ : 1;
  local.meanVariance /= density * density;
  local.modelVariance = modelVariance_ * spread / (density * density);
  return local;
}

}  // namespace pixelflex::calib
