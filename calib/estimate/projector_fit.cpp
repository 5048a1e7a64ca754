#include "calib/estimate/projector_fit.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "calib/estimate/collineation.h"
#include "calib/geometry/brown_lens.h"
#include "calib/geometry/projector_mapping.h"

namespace pixelflex::calib {
namespace {

constexpr double kHuberPx = 0.3;
constexpr double kCentrePriorPx = 5000;

/// The unknowns, as Ceres blocks. The homography takes wall coordinates of unit spread to the normalised plane.
struct Unknowns {
  std::array<double, 8> homography{};
  std::array<double, 3> radial{};
  std::array<double, 2> tangential{};
  std::array<double, 2> centre{};  // projector pixels
};

struct SampleResidual {
  glm::dvec2 inWall;  // normalised
  glm::dvec2 inProjector;
  double scale;

  template <class T>
  bool operator()(const T* h, const T* radial, const T* tangential, const T* centre, T* residual) const {
    const T w = h[6] * inWall.x + h[7] * inWall.y + T(1);
    const T x = (h[0] * inWall.x + h[1] * inWall.y + h[2]) / w;
    const T y = (h[3] * inWall.x + h[4] * inWall.y + h[5]) / w;
    // The homography maps to pixels about the frame's middle; the lens works about its own centre.
    const T cx = (centre[0]) / scale;
    const T cy = (centre[1]) / scale;
    T dx;
    T dy;
    BrownLens::distort(T(x - cx), T(y - cy), radial, tangential, &dx, &dy);
    residual[0] = (dx + cx) * scale - inProjector.x;
    residual[1] = (dy + cy) * scale - inProjector.y;
    return true;
  }
};

struct CentrePrior {
  template <class T>
  bool operator()(const T* centre, T* residual) const {
    residual[0] = centre[0] / kCentrePriorPx;
    residual[1] = centre[1] / kCentrePriorPx;
    return true;
  }
};

Homography wallNormaliser(std::span<const Sample> samples) {
  glm::dvec2 mean{0, 0};
  for (const auto& sample : samples) mean += sample.pointInWall;
  mean /= static_cast<double>(samples.size());
  double spread = 0;
  for (const auto& sample : samples) spread += glm::length(sample.pointInWall - mean);
  spread /= static_cast<double>(samples.size());
  if (!(spread > 0)) throw EstimateError("all samples of the projector lie in one place");
  return Homography::scaling(glm::dvec2(1 / spread)) * Homography::translation(-mean);
}

FitQuality qualityOf(std::span<const Sample> samples, const ProjectorModel& model, devices::Size resolution) {
  const ProjectorMapping mapping(model, resolution);
  std::vector<double> errors;
  for (const auto& sample : samples) {
    const auto mapped = mapping.projectorFromWall(sample.pointInWall);
    if (!mapped) throw EstimateError("a sample lies outside the fitted lens: the samples do not fit a projector");
    errors.push_back(glm::length(*mapped - sample.pointInProjector));
  }
  std::ranges::sort(errors);
  double squares = 0;
  for (const double error : errors) squares += error * error;
  const auto count = errors.size();
  return {.rms = std::sqrt(squares / static_cast<double>(count)),
          .p95 = errors[static_cast<std::size_t>(0.95 * static_cast<double>(count - 1))],
          .maximum = errors.back(),
          .found = static_cast<int>(count)};
}

void solve(Unknowns& unknowns, std::span<const Sample> samples, const Homography& normalise, glm::dvec2 middle,
           double scale) {
  ceres::Problem problem;
  for (const auto& sample : samples) {
    auto* cost = new ceres::AutoDiffCostFunction<SampleResidual, 2, 8, 3, 2, 2>(
        new SampleResidual{normalise.map(sample.pointInWall), sample.pointInProjector - middle, scale});
    problem.AddResidualBlock(cost, new ceres::HuberLoss(kHuberPx), unknowns.homography.data(), unknowns.radial.data(),
                             unknowns.tangential.data(), unknowns.centre.data());
  }
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<CentrePrior, 2, 2>(new CentrePrior), nullptr,
                           unknowns.centre.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) throw EstimateError("the projector's lens cannot be solved: " + summary.message);
}

}  // namespace

ProjectorFit fitProjector(std::span<const Sample> samples, devices::Size resolution) {
  constexpr std::size_t kFewest = 12;
  if (samples.size() < kFewest) {
    throw EstimateError(std::to_string(samples.size()) + " samples; at least 12 are needed to fit a projector");
  }
  const glm::dvec2 middle{resolution.width / 2.0, resolution.height / 2.0};
  const double scale = resolution.width;
  const Homography normalise = wallNormaliser(samples);
  std::vector<PointPair> pairs;
  for (const auto& sample : samples) {
    pairs.push_back({normalise.map(sample.pointInWall), (sample.pointInProjector - middle) / scale});
  }
  const Homography start = solveCollineation(pairs);
  Unknowns unknowns;
  for (std::size_t i = 0; i < 8; ++i) unknowns.homography[i] = start.rowMajor()[i] / start.rowMajor()[8];
  solve(unknowns, samples, normalise, middle, scale);

  std::array<double, 9> h{};
  std::ranges::copy(unknowns.homography, h.begin());
  h[8] = 1;
  const glm::dvec2 centre{unknowns.centre[0], unknowns.centre[1]};
  const Homography aboutCentre = Homography::translation(-centre / scale) * Homography(h) * normalise;
  ProjectorFit fit;
  fit.model = {.projectorFromWall = aboutCentre.rowMajor(),
               .centre = middle + centre,
               .scale = scale,
               .radial = unknowns.radial,
               .tangential = unknowns.tangential};
  fit.quality = qualityOf(samples, fit.model, resolution);
  return fit;
}

}  // namespace pixelflex::calib
