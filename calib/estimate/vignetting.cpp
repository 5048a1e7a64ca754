#include "calib/estimate/vignetting.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

namespace pixelflex::calib {
namespace {

using Eigen::Index;

constexpr Index kOfCamera = 2;     // loss, and what the fourth power of the radius adds to it
constexpr Index kOfProjector = 5;  // level, loss, fourth power, two of a slope
constexpr int kRounds = 6;

/// What is known of lenses before anything is seen: mean and deviation of a parameter. Without it a camera that sees
/// few projectors could trade its own loss for theirs. Slopes are small: they stand for a lens off its frame's middle.
struct Prior {
  double mean, deviation;
};
constexpr Prior kLoss{0.25, 0.15};
constexpr Prior kFourth{0, 0.03};
constexpr Prior kSlope{0, 0.02};
/// The samples of a projector disagree with the model by this much, and not independently: they count as so many.
constexpr double kDeviation = 0.01;
constexpr double kIndependent = 400;

/// Lenses lose light with the square of the radius: ln(1 - loss r^2) + fourth r^4, and its derivatives.
struct LogTransmission {
  double value, byLoss, byFourth;
};

LogTransmission logTransmission(double square, double loss, double fourth) {
  const double passed = std::max(0.05, 1 - loss * square);
  return {std::log(passed) + fourth * square * square, -square / passed, square * square};
}

class VignettingFit {
 public:
  VignettingFit(std::span<const SeenLight> samples, std::size_t projectors, const CameraVignetting& start)
      : samples_(samples),
        start_(start),
        size_(kOfCamera + kOfProjector * static_cast<Index>(projectors)),
        solution_(Eigen::VectorXd::Zero(size_)),
        weights_(samples.size(), 1) {
    std::vector<double> counts(projectors, 0);
    for (const auto& sample : samples) ++counts[sample.projector];
    for (const double count : counts) trust_.push_back(kIndependent / std::max(count, kIndependent));
    solution_(0) = kLoss.mean;
    for (Index first = kOfCamera; first < size_; first += kOfProjector) solution_(first + 1) = kLoss.mean;
  }

  /// Gauss-Newton; outliers lose weight from round to round.
  std::array<double, 2> solve() {
    for (int round = 0; round < kRounds; ++round) {
      step();
      reweigh();
    }
    return {solution_(0), solution_(1)};
  }

 private:
  struct Row {
    std::array<Index, kOfCamera + kOfProjector> index{};
    std::array<double, kOfCamera + kOfProjector> value{};  // derivatives
    double rest = 0;
  };

  [[nodiscard]] Row rowOf(const SeenLight& sample) const {
    const glm::dvec2 r = (sample.inCamera - start_.centre) / start_.halfDiagonal;
    const glm::dvec2 f = sample.offMiddle;
    const Index first = kOfCamera + kOfProjector * static_cast<Index>(sample.projector);
    const auto camera = logTransmission(glm::dot(r, r), solution_(0), solution_(1));
    const auto frame = logTransmission(glm::dot(f, f), solution_(first + 1), solution_(first + 2));
    const double fitted =
        camera.value + frame.value + solution_(first) + f.x * solution_(first + 3) + f.y * solution_(first + 4);
    Row row;
    row.value = {camera.byLoss, camera.byFourth, 1, frame.byLoss, frame.byFourth, f.x, f.y};
    row.index = {0, 1, first, first + 1, first + 2, first + 3, first + 4};
    row.rest = std::log(sample.light) - 2 * std::log(sample.density) - fitted;
    return row;
  }

  void step() {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(size_, size_) * 1e-9;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size_);
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Row row = rowOf(samples_[i]);
      const double weight = weights_[i] * trust_[samples_[i].projector] / (kDeviation * kDeviation);
      for (std::size_t a = 0; a < row.value.size(); ++a) {
        right(row.index[a]) += weight * row.value[a] * row.rest;
        for (std::size_t b = 0; b < row.value.size(); ++b) {
          normal(row.index[a], row.index[b]) += weight * row.value[a] * row.value[b];
        }
      }
    }
    const auto expect = [&](Index parameter, const Prior& prior) {
      const double weight = 1 / (prior.deviation * prior.deviation);
      normal(parameter, parameter) += weight;
      right(parameter) += weight * (prior.mean - solution_(parameter));
    };
    expect(0, kLoss);
    expect(1, kFourth);
    for (Index first = kOfCamera; first < size_; first += kOfProjector) {
      expect(first + 1, kLoss);
      expect(first + 2, kFourth);
      expect(first + 3, kSlope);
      expect(first + 4, kSlope);
    }
    solution_ += normal.ldlt().solve(right);
  }

  void reweigh() {
    std::vector<double> errors;
    for (const auto& sample : samples_) errors.push_back(std::abs(rowOf(sample).rest));
    std::vector<double> sorted = errors;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double limit = std::max(3 * *middle, 1e-6);
    for (std::size_t i = 0; i < errors.size(); ++i) weights_[i] = errors[i] <= limit ? 1 : limit / errors[i];
  }

  std::span<const SeenLight> samples_;
  CameraVignetting start_;
  Index size_;
  Eigen::VectorXd solution_;
  std::vector<double> weights_;
  std::vector<double> trust_;  // of a sample, by projector
};

}  // namespace

double CameraVignetting::transmission(glm::dvec2 inCamera) const {
  const glm::dvec2 r = (inCamera - centre) / halfDiagonal;
  return std::exp(logTransmission(glm::dot(r, r), terms[0], terms[1]).value);
}

CameraVignetting estimateVignetting(std::span<const SeenLight> samples, std::size_t projectors,
                                    const CameraIntrinsics& camera) {
  constexpr std::size_t kFewest = 100;
  std::vector<SeenLight> lit;
  std::ranges::copy_if(samples, std::back_inserter(lit),
                       [](const SeenLight& sample) { return sample.light > 0 && sample.density > 0; });
  if (lit.size() < kFewest) {
    throw EstimateError("the projectors' white is seen at " + std::to_string(lit.size()) +
                        " places only; their light cannot be compared");
  }
  CameraVignetting vignetting;
  vignetting.centre = {camera.cx, camera.cy};
  vignetting.halfDiagonal = 0.5 * std::hypot(camera.size.width, camera.size.height);
  vignetting.terms = VignettingFit(lit, projectors, vignetting).solve();
  return vignetting;
}

}  // namespace pixelflex::calib
