#include "calib/estimate/projector_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "calib/estimate/lens_solver.h"
#include "calib/estimate/residual_fit.h"
#include "calib/geometry/projector_mapping.h"

namespace pixelflex::calib {
namespace {

/// Neighbours on a lattice of samples fall into different folds.
std::vector<int> foldsOf(std::size_t count) {
  std::vector<int> folds;
  for (std::size_t i = 0; i < count; ++i) {
    folds.push_back(static_cast<int>((i * 2654435761U >> 7U) % static_cast<unsigned>(kFolds)));
  }
  return folds;
}

std::vector<ResidualSample> residualsOf(std::span<const Sample> samples, std::span<const int> folds,
                                        const ProjectorModel& lens, devices::Size resolution) {
  const ProjectorMapping mapping(lens, resolution);
  std::vector<ResidualSample> residuals;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto mapped = mapping.projectorFromWall(samples[i].pointInWall);
    if (!mapped) throw EstimateError("a sample lies outside the fitted lens: the samples do not fit a projector");
    residuals.push_back({*mapped, samples[i].pointInProjector - *mapped, folds[i]});
  }
  return residuals;
}

std::vector<double> errorsOf(std::span<const Sample> samples, const ProjectorModel& model, devices::Size resolution) {
  const ProjectorMapping mapping(model, resolution);
  std::vector<double> errors;
  for (const auto& sample : samples) {
    const auto mapped = mapping.projectorFromWall(sample.pointInWall);
    if (!mapped) throw EstimateError("a sample lies outside the fitted lens: the samples do not fit a projector");
    errors.push_back(glm::length(*mapped - sample.pointInProjector));
  }
  return errors;
}

double rmsOf(const std::vector<double>& errors) {
  double squares = 0;
  for (const double error : errors) squares += error * error;
  return errors.empty() ? 0 : std::sqrt(squares / static_cast<double>(errors.size()));
}

FitQuality qualityOf(std::vector<double> errors) {
  std::ranges::sort(errors);
  const std::size_t count = errors.size();
  return {.rms = rmsOf(errors),
          .p95 = errors[static_cast<std::size_t>(0.95 * static_cast<double>(count - 1))],
          .maximum = errors.back(),
          .found = static_cast<int>(count)};
}

/// Error of every sample under the model fitted without its fold.
double heldOutError(LensSolver& solver, std::span<const Sample> samples, std::span<const int> folds,
                    devices::Size resolution, const std::optional<ResidualChoice>& choice) {
  std::vector<double> errors;
  for (int fold = 0; fold < kFolds; ++fold) {
    solver.solve(folds, fold);
    ProjectorModel model = solver.model();
    if (choice) {
      model.residual = fitResidual(residualsOf(samples, folds, model, resolution), *choice, resolution, fold);
    }
    const auto all = errorsOf(samples, model, resolution);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (folds[i] == fold) errors.push_back(all[i]);
    }
  }
  return rmsOf(errors);
}

}  // namespace

ProjectorFit fitProjector(std::span<const Sample> samples, devices::Size resolution,
                          const std::optional<BentScreen>& screen) {
  constexpr std::size_t kFewest = 12;
  if (samples.size() < kFewest) {
    throw EstimateError(std::to_string(samples.size()) + " samples; at least 12 are needed to fit a projector");
  }
  LensSolver solver(samples, resolution, screen);
  solver.solve();
  ProjectorFit fit{.model = solver.model()};
  const double deviation = solver.deviation();
  const std::vector<int> folds = foldsOf(samples.size());
  const auto residuals = residualsOf(samples, folds, fit.model, resolution);
  const auto choice = chooseResidual(residuals, resolution);
  if (choice) fit.model.residual = fitResidual(residuals, *choice, resolution);
  fit.quality = qualityOf(errorsOf(samples, fit.model, resolution));
  fit.quality.deviation = deviation;
  fit.quality.heldOut = heldOutError(solver, samples, folds, resolution, choice);
  return fit;
}

}  // namespace pixelflex::calib
