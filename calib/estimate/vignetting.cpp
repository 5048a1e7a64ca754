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

constexpr Index kOfCamera = 2;
constexpr Index kOfProjector = 5;  // level, two radial terms about the frame's middle, two of a slope
/// A slope may be a decentred projector lens or the camera's; the prior, in parts of a projector's samples, gives it to
/// the camera.
constexpr double kSlopePrior = 1;

class VignettingFit {
 public:
  VignettingFit(std::span<const SeenLight> samples, std::size_t projectors, const CameraVignetting& start)
      : samples_(samples), start_(start), size_(kOfCamera + kOfProjector * static_cast<Index>(projectors)) {}

  Eigen::VectorXd solve() const {
    std::vector<double> weights(samples_.size(), 1);
    Eigen::VectorXd solution = solveWeighted(weights);
    for (int round = 0; round < 3; ++round) {
      reweigh(solution, weights);
      solution = solveWeighted(weights);
    }
    return solution;
  }

 private:
  struct Row {
    std::array<Index, kOfCamera + kOfProjector> index{};
    std::array<double, kOfCamera + kOfProjector> value{};
    double right = 0;
  };

  [[nodiscard]] Row rowOf(const SeenLight& sample) const {
    const glm::dvec2 r = (sample.inCamera - start_.centre) / start_.halfDiagonal;
    const glm::dvec2 f = 2.0 * sample.inFrame - 1.0;
    const double camera = glm::dot(r, r);
    const double frame = 0.5 * glm::dot(f, f);
    Row row;
    row.value = {camera, camera * camera, 1, frame, frame * frame, f.x, f.y};
    const Index first = kOfCamera + kOfProjector * static_cast<Index>(sample.projector);
    row.index = {0, 1, first, first + 1, first + 2, first + 3, first + 4};
    row.right = std::log(sample.light) - 2 * std::log(sample.density);
    return row;
  }

  [[nodiscard]] Eigen::VectorXd solveWeighted(const std::vector<double>& weights) const {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(size_, size_) * 1e-6;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size_);
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Row row = rowOf(samples_[i]);
      for (std::size_t a = 0; a < row.value.size(); ++a) {
        right(row.index[a]) += weights[i] * row.value[a] * row.right;
        for (std::size_t b = 0; b < row.value.size(); ++b) {
          normal(row.index[a], row.index[b]) += weights[i] * row.value[a] * row.value[b];
        }
      }
    }
    for (Index first = kOfCamera; first < size_; first += kOfProjector) {
      const double prior = kSlopePrior * normal(first, first);  // the level's diagonal counts the samples
      normal(first + 3, first + 3) += prior;
      normal(first + 4, first + 4) += prior;
    }
    return normal.ldlt().solve(right);
  }

  void reweigh(const Eigen::VectorXd& solution, std::vector<double>& weights) const {
    std::vector<double> errors;
    for (const auto& sample : samples_) {
      const Row row = rowOf(sample);
      double fitted = 0;
      for (std::size_t a = 0; a < row.value.size(); ++a) fitted += row.value[a] * solution(row.index[a]);
      errors.push_back(std::abs(fitted - row.right));
    }
    std::vector<double> sorted = errors;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double limit = std::max(3 * *middle, 1e-6);
    for (std::size_t i = 0; i < errors.size(); ++i) weights[i] = errors[i] <= limit ? 1 : limit / errors[i];
  }

  std::span<const SeenLight> samples_;
  CameraVignetting start_;
  Index size_;
};

}  // namespace

double CameraVignetting::transmission(glm::dvec2 inCamera) const {
  const glm::dvec2 r = (inCamera - centre) / halfDiagonal;
  const double square = glm::dot(r, r);
  return std::exp(square * (terms[0] + square * terms[1]));
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
  const Eigen::VectorXd solution = VignettingFit(lit, projectors, vignetting).solve();
  vignetting.terms = {solution(0), solution(1)};
  return vignetting;
}

}  // namespace pixelflex::calib
