#include "calib/estimate/fiducial_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "calib/estimate/collineation.h"
#include "calib/estimate/fiducial_model.h"

namespace pixelflex::calib {
namespace {

constexpr double kLargest = 48;  // pixels of side that are looked at; larger markers are averaged down

/// Four corners (x, y), blur, black, white - black, and the light's slope in x and y.
constexpr int kParameters = 13;
using Parameters = Eigen::Matrix<double, kParameters, 1>;
using Normal = Eigen::Matrix<double, kParameters, kParameters>;

struct MarkerSample {
  glm::dvec2 at{0, 0};  // undistorted pixels
  double light = 0;
};

double cross(glm::dvec2 a, glm::dvec2 b) {
  return a.x * b.y - a.y * b.x;
}

glm::dvec2 crossing(const std::array<glm::dvec2, 4>& corner) {
  const glm::dvec2 along = corner[2] - corner[0];
  const glm::dvec2 other = corner[3] - corner[1];
  return corner[0] + along * (cross(corner[1] - corner[0], other) / cross(along, other));
}

double longestSide(const std::array<glm::dvec2, 4>& corners) {
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i) longest = std::max(longest, glm::length(corners[(i + 1) % 4] - corners[i]));
  return longest;
}

class MarkerProblem {
 public:
  MarkerProblem(const MarkerModules& modules, std::vector<MarkerSample> samples, glm::dvec2 middle)
      : marker_(modules), samples_(std::move(samples)), middle_(middle) {}

  [[nodiscard]] bool enough() const { return samples_.size() > std::size_t{3} * kParameters; }

  static std::array<glm::dvec2, 4> cornersOf(const Parameters& p) {
    return {glm::dvec2(p[0], p[1]), glm::dvec2(p[2], p[3]), glm::dvec2(p[4], p[5]), glm::dvec2(p[6], p[7])};
  }

  /// Sum of squared residuals; also the normal equations when asked for.
  double evaluate(const Parameters& p, Normal* normal, Parameters* gradient) const {
    const auto corners = cornersOf(p);
    const Homography markerFromCamera = markerFrom(corners);
    std::array<Homography, 8> moved;
    constexpr double kStep = 1e-3;
    if (normal != nullptr) {
      normal->setZero();
      gradient->setZero();
      for (int i = 0; i < 8; ++i) {
        Parameters nudged = p;
        nudged[i] += kStep;
        moved[static_cast<std::size_t>(i)] = markerFrom(cornersOf(nudged));
      }
    }
    double cost = 0;
    for (const auto& sample : samples_) {
      const glm::dvec2 at = markerFromCamera.map(sample.at);
      const glm::dvec2 scale = scaleAt(markerFromCamera, sample.at, at);
      const auto value = marker_.at(at, p[8] * scale);
      const glm::dvec2 aside = sample.at - middle_;
      const double slope = 1 + p[11] * aside.x + p[12] * aside.y;
      const double flat = p[9] + p[10] * value.white;
      const double residual = flat * slope - sample.light;
      cost += residual * residual;
      if (normal == nullptr) continue;
      Parameters j;
      for (int i = 0; i < 8; ++i) {
        const glm::dvec2 by = (moved[static_cast<std::size_t>(i)].map(sample.at) - at) / kStep;
        j[i] = p[10] * slope * (value.byX * by.x + value.byY * by.y);
      }
      const double wider = marker_.at(at, (p[8] + kStep) * scale).white;
      j[8] = p[10] * slope * (wider - value.white) / kStep;
      j[9] = slope;
      j[10] = slope * value.white;
      j[11] = flat * aside.x;
      j[12] = flat * aside.y;
      *normal += j * j.transpose();
      *gradient += j * residual;
    }
    return cost;
  }

  /// Share of the picture's variation that the marker explains.
  [[nodiscard]] double agreement(double cost) const {
    double mean = 0;
    for (const auto& sample : samples_) mean += sample.light / static_cast<double>(samples_.size());
    double total = 0;
    for (const auto& sample : samples_) total += (sample.light - mean) * (sample.light - mean);
    return total > 0 ? 1 - cost / total : 0;
  }

 private:
  static Homography markerFrom(const std::array<glm::dvec2, 4>& corners) {
    const std::array<PointPair, 4> pairs = {PointPair{corners[0], {0, 0}}, PointPair{corners[1], {1, 0}},
                                            PointPair{corners[2], {1, 1}}, PointPair{corners[3], {0, 1}}};
    return solveCollineation(pairs);
  }

  /// Marker units per pixel, along the marker's axes.
  static glm::dvec2 scaleAt(const Homography& markerFromCamera, glm::dvec2 pixel, glm::dvec2 at) {
    const glm::dvec2 right = markerFromCamera.map(pixel + glm::dvec2(0.5, 0)) - at;
    const glm::dvec2 down = markerFromCamera.map(pixel + glm::dvec2(0, 0.5)) - at;
    return 2.0 * glm::dvec2(std::hypot(right.x, down.x), std::hypot(right.y, down.y));
  }

  SmoothMarker marker_;
  std::vector<MarkerSample> samples_;
  glm::dvec2 middle_;
};

/// The picture within the marker and half a module around it, `step` x `step` pixels averaged to one.
std::vector<MarkerSample> samplesOf(const devices::Image8& grey, const CameraMapping& camera,
                                    const std::array<glm::dvec2, 4>& corners, int step) {
  const glm::dvec2 centre = crossing(corners);
  std::array<glm::dvec2, 4> outer{};
  glm::dvec2 low = centre;
  glm::dvec2 high = centre;
  for (std::size_t i = 0; i < 4; ++i) {
    outer[i] = centre + (corners[i] - centre) * 1.2;
    low = {std::min(low.x, outer[i].x), std::min(low.y, outer[i].y)};
    high = {std::max(high.x, outer[i].x), std::max(high.y, outer[i].y)};
  }
  const auto inside = [&](glm::dvec2 p) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (cross(outer[(i + 1) % 4] - outer[i], p - outer[i]) < 0) return false;
    }
    return true;
  };
  std::vector<MarkerSample> samples;
  for (int y = std::max(0, int(low.y)); y + step <= std::min(grey.height(), int(high.y) + step); y += step) {
    for (int x = std::max(0, int(low.x)); x + step <= std::min(grey.width(), int(high.x) + step); x += step) {
      const glm::dvec2 raw{x + 0.5 * step, y + 0.5 * step};
      if (!inside(raw)) continue;
      double sum = 0;
      for (int j = 0; j < step; ++j) {
        for (int i = 0; i < step; ++i) sum += grey.at(x + i, y + j);
      }
      samples.push_back({camera.undistortedFromRaw(raw), sum / (step * step)});
    }
  }
  return samples;
}

/// Levenberg-Marquardt.
std::optional<double> minimise(const MarkerProblem& problem, Parameters& p) {
  Normal normal;
  Parameters gradient;
  double damping = 1e-3;
  double cost = problem.evaluate(p, &normal, &gradient);
  for (int iteration = 0; iteration < 30 && damping < 1e6; ++iteration) {
    Normal damped = normal;
    damped.diagonal() *= 1 + damping;
    const Parameters step = damped.ldlt().solve(-gradient);
    const Parameters candidate = p + step;
    const bool possible = step.allFinite() && candidate[8] > 0.2 && candidate[8] < 20;
    const double next = possible ? problem.evaluate(candidate, nullptr, nullptr) : cost;
    if (next >= cost) {
      damping *= 8;
      continue;
    }
    p = candidate;
    damping = std::max(1e-9, damping / 8);
    cost = problem.evaluate(p, &normal, &gradient);
    if (step.head<8>().cwiseAbs().maxCoeff() < 1e-3) break;
  }
  return std::isfinite(cost) ? std::optional(cost) : std::nullopt;
}

}  // namespace

std::optional<MarkerFit> fitMarker(const devices::Image8& grey, const CameraMapping& camera,
                                   const MarkerModules& modules, const std::array<glm::dvec2, 4>& corners) {
  const double side = longestSide(corners);
  const int step = std::max(1, static_cast<int>(std::ceil(side / kLargest)));
  std::vector<MarkerSample> samples = samplesOf(grey, camera, corners, step);
  if (samples.empty()) return std::nullopt;
  const auto [dark, bright] = std::ranges::minmax(samples, {}, &MarkerSample::light);
  Parameters start;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec2 undistorted = camera.undistortedFromRaw(corners[i]);
    start[static_cast<Eigen::Index>(2 * i)] = undistorted.x;
    start[static_cast<Eigen::Index>(2 * i) + 1] = undistorted.y;
  }
  start.tail<5>() << 0.7 * step, dark.light, std::max(1.0, bright.light - dark.light), 0, 0;
  const MarkerProblem problem(modules, std::move(samples), camera.undistortedFromRaw(crossing(corners)));
  if (!problem.enough()) return std::nullopt;
  try {
    Parameters found = start;
    const auto cost = minimise(problem, found);
    const double moved = (found - start).head<8>().cwiseAbs().maxCoeff();
    if (!cost || moved > 0.2 * side || found[10] <= 0) return std::nullopt;
    const auto fitted = MarkerProblem::cornersOf(found);
    return MarkerFit{fitted, crossing(fitted), problem.agreement(*cost)};
  } catch (const EstimateError&) {  // corners that fell into a line
    return std::nullopt;
  }
}

}  // namespace pixelflex::calib
