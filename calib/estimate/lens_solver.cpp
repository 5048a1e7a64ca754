#include "calib/estimate/lens_solver.h"

#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "calib/estimate/collineation.h"
#include "calib/estimate/lens_residual.h"
#include "calib/geometry/projector_mapping.h"

namespace pixelflex::calib {
namespace {

constexpr double kHuberPx = 0.3;

struct SampleResidual {
  glm::dvec3 onScreen;  // normalised
  glm::dvec2 inProjector;
  double scale;

  template <class T>
  bool operator()(const T* h, const T* depth, const T* radial, const T* tangential, const T* centre,
                  T* residual) const {
    const T point[3] = {T(onScreen.x), T(onScreen.y), T(onScreen.z)};
    lensPixel(h, depth, radial, tangential, centre, scale, point, residual);
    residual[0] -= inProjector.x;
    residual[1] -= inProjector.y;
    return true;
  }
};

Eigen::MatrixXd dense(const ceres::CRSMatrix& sparse) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row) {
    const auto r = static_cast<std::size_t>(row);
    for (int k = sparse.rows[r]; k < sparse.rows[r + 1]; ++k) {
      matrix(row, sparse.cols[static_cast<std::size_t>(k)]) = sparse.values[static_cast<std::size_t>(k)];
    }
  }
  return matrix;
}

}  // namespace

/// The least-squares problem over some points, on a copy of the unknowns or on the solver's own.
struct LensSolver::System {
  System(Unknowns& values, bool bent) : unknowns(values) {
    problem.AddParameterBlock(unknowns.homography.data(), 8);
    problem.AddParameterBlock(unknowns.depth.data(), 3);
    problem.AddParameterBlock(unknowns.radial.data(), 3);
    problem.AddParameterBlock(unknowns.tangential.data(), 2);
    problem.AddParameterBlock(unknowns.centre.data(), 2);
    if (!bent) problem.SetParameterBlockConstant(unknowns.depth.data());
  }

  void add(glm::dvec3 onScreen, glm::dvec2 inProjector, double scale, double huber) {
    auto* cost = new ceres::AutoDiffCostFunction<SampleResidual, 2, 8, 3, 3, 2, 2>(
        new SampleResidual{onScreen, inProjector, scale});
    problem.AddResidualBlock(cost, huber > 0 ? new ceres::HuberLoss(huber) : nullptr, unknowns.homography.data(),
                             unknowns.depth.data(), unknowns.radial.data(), unknowns.tangential.data(),
                             unknowns.centre.data());
  }

  void addPrior() {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<LensCentrePrior, 2, 2>(new LensCentrePrior), nullptr,
                             unknowns.centre.data());
  }

  /// Rows: the residuals in the order added; columns: the unknowns that are not constant.
  [[nodiscard]] Eigen::MatrixXd jacobian(std::vector<double>* residuals) {
    ceres::CRSMatrix sparse;
    problem.Evaluate({}, nullptr, residuals, nullptr, &sparse);
    return dense(sparse);
  }

  Unknowns& unknowns;
  ceres::Problem problem;
};

LensSolver::LensSolver(std::span<const Sample> samples, devices::Size resolution,
                       const std::optional<BentScreen>& screen)
    : samples_(samples),
      screen_(screen),
      resolution_(resolution),
      middle_(resolution.width / 2.0, resolution.height / 2.0),
      scale_(resolution.width) {
  glm::dvec2 mean{0, 0};
  for (const auto& sample : samples) mean += sample.pointInWall;
  mean /= static_cast<double>(samples.size());
  double spread = 0;
  for (const auto& sample : samples) spread += glm::length(sample.pointInWall - mean);
  spread_ = spread / static_cast<double>(samples.size());
  if (!(spread_ > 0)) throw EstimateError("all samples of the projector lie in one place");
  normalise_ = Homography::scaling(glm::dvec2(1 / spread_)) * Homography::translation(-mean);
}

glm::dvec3 LensSolver::normalised(glm::dvec2 pointInWall) const {
  if (!screen_) return {normalise_.map(pointInWall), 0};
  const double t = (pointInWall.x - screen_->apex) / screen_->radius;
  const glm::dvec2 across{screen_->apex + screen_->radius * std::sin(t), pointInWall.y};
  return {normalise_.map(across), screen_->radius * (std::cos(t) - 1) / spread_};
}

void LensSolver::startFromHomography() {
  std::vector<PointPair> pairs;
  for (const auto& sample : samples_) {
    pairs.push_back({glm::dvec2(normalised(sample.pointInWall)), (sample.pointInProjector - middle_) / scale_});
  }
  const Homography start = solveCollineation(pairs);
  for (std::size_t i = 0; i < 8; ++i) unknowns_.homography[i] = start.rowMajor()[i] / start.rowMajor()[8];
  started_ = true;
}

void LensSolver::solve(std::span<const int> fold, int leftOut) {
  if (!started_) startFromHomography();
  minimise(fold, leftOut, kHuberPx);
  // What no lens explains (a curved screen, say) is not an outlier: a wider loss then averages it.
  const double usual = 3 * medianError();
  if (usual > kHuberPx) minimise(fold, leftOut, usual);
}

void LensSolver::minimise(std::span<const int> fold, int leftOut, double huber) {
  System system(unknowns_, screen_.has_value());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (!fold.empty() && fold[i] == leftOut) continue;
    system.add(normalised(samples_[i].pointInWall), samples_[i].pointInProjector - middle_, scale_, huber);
  }
  system.addPrior();
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &system.problem, &summary);
  if (!summary.IsSolutionUsable()) throw EstimateError("the projector's lens cannot be solved: " + summary.message);
}

double LensSolver::medianError() const {
  const ProjectorMapping mapping(model(), resolution_);
  std::vector<double> errors;
  for (const auto& sample : samples_) {
    const auto mapped = mapping.projectorFromWall(sample.pointInWall);
    if (mapped) errors.push_back(glm::length(*mapped - sample.pointInProjector));
  }
  if (errors.empty()) throw EstimateError("the samples do not fit a projector");
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

ProjectorModel LensSolver::model() const {
  std::array<double, 9> h{};
  std::ranges::copy(unknowns_.homography, h.begin());
  h[8] = 1;
  const glm::dvec2 centre{unknowns_.centre[0], unknowns_.centre[1]};
  const glm::dvec2 shift = centre / scale_;
  const Homography aboutCentre = Homography::translation(-shift) * Homography(h) * normalise_;
  ProjectorModel model{.projectorFromWall = aboutCentre.rowMajor(),
                       .centre = middle_ + centre,
                       .scale = scale_,
                       .radial = unknowns_.radial,
                       .tangential = unknowns_.tangential};
  if (screen_) {
    const auto& d = unknowns_.depth;
    model.bend = Bend{screen_->radius,
                      screen_->apex,
                      {(d[0] - shift.x * d[2]) / spread_, (d[1] - shift.y * d[2]) / spread_, d[2] / spread_}};
  }
  return model;
}

double LensSolver::deviation() const {
  Unknowns copy = unknowns_;
  System measured(copy, screen_.has_value());
  for (const auto& sample : samples_) {
    measured.add(normalised(sample.pointInWall), sample.pointInProjector - middle_, scale_, kHuberPx);
  }
  measured.addPrior();
  std::vector<double> residuals;
  const Eigen::MatrixXd j = measured.jacobian(&residuals);
  double squares = 0;
  for (const double residual : residuals) squares += residual * residual;
  const double variance = squares / std::max(1.0, static_cast<double>(j.rows() - j.cols()));

  constexpr int kLattice = 5;
  const ProjectorMapping mapping(model(), resolution_);
  System frame(copy, screen_.has_value());
  for (int i = 0; i < kLattice * kLattice; ++i) {
    const glm::dvec2 part(i % kLattice / double(kLattice - 1), static_cast<int>(i / kLattice) / double(kLattice - 1));
    const auto inWall = mapping.wallFromProjector(part * 2.0 * middle_);
    if (inWall) frame.add(normalised(*inWall), {0, 0}, scale_, 0);
  }
  const Eigen::MatrixXd predicted = frame.jacobian(nullptr);
  if (predicted.rows() == 0) return 0;
  const auto inverse = (j.transpose() * j).completeOrthogonalDecomposition().pseudoInverse();
  const double trace = (predicted * inverse * predicted.transpose()).trace();
  return std::sqrt(std::max(0.0, 2 * variance * trace / static_cast<double>(predicted.rows())));
}

}  // namespace pixelflex::calib
