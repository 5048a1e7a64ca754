#include "calib/estimate/camera_response.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "calib/estimate/intrinsics.h"
#include "calib/estimate/response_samples.h"
#include "calib/photometric/monotone.h"

namespace pixelflex::calib {
namespace {

using Curve = std::array<double, 256>;

constexpr std::size_t kFewestPhotos = 3;
constexpr double kLeastSpan = 3;          // longest over shortest exposure
constexpr double kLargestGap = 40;        // codes
constexpr double kLargestResidual = 0.1;  // relative
constexpr double kSmoothness = 1e-6;
constexpr double kShift = 8;  // codes
constexpr std::array<std::string_view, 3> kChannels = {"red", "green", "blue"};

std::string number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

double meanCode(const devices::Image8& photo) {
  double sum = 0;
  for (const auto code : photo.samples()) sum += code;
  return sum / static_cast<double>(photo.samples().size());
}

void checkSeries(const std::vector<ExposedPhoto>& photos) {
  if (photos.size() < kFewestPhotos) {
    throw EstimateError("the camera's response needs three photographs or more with different exposures, found " +
                        std::to_string(photos.size()));
  }
  for (const auto& one : photos) {
    if (!(one.exposure > 0) || !std::isfinite(one.exposure)) {
      throw EstimateError("an exposure must be a positive number, found " + number(one.exposure));
    }
    if (one.photo.channels() != 3 || one.photo.size() != photos.front().photo.size()) {
      throw EstimateError("the photographs of an exposure series must be colour photographs of one size");
    }
  }
  if (photos.back().exposure < kLeastSpan * photos.front().exposure) {
    throw EstimateError("the exposures are too much alike: the longest must be " + number(kLeastSpan) +
                        " times the shortest or more, better a hundred times");
  }
}

/// More exposure makes a brighter photograph, unless all is black or white already.
void checkOrder(const std::vector<ExposedPhoto>& photos) {
  for (std::size_t i = 0; i + 1 < photos.size(); ++i) {
    const double before = meanCode(photos[i].photo);
    const double after = meanCode(photos[i + 1].photo);
    if (photos[i].exposure == photos[i + 1].exposure || after > before + 0.25 || after < 2 || before > 253) continue;
    throw EstimateError("the photograph with exposure " + number(photos[i + 1].exposure) +
                        " is not brighter than the one with " + number(photos[i].exposure) +
                        ": check their order, and that the camera does not choose the exposure itself");
  }
}

/// Sum over measurements of weight * (value - curve)^2 as normal equations in the 256 values of the curve.
struct Equations {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(256, 256);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(256);
  double weight = 0;
};

/// Mean codes are equally noisy; their logarithm of light is the better known the brighter they are, up to clipping.
double weightOf(double code) {
  return std::pow((code + kShift) / 128, 2) * std::clamp((252 - code) / 20, 0.01, 1.0);
}

/// The curve at a code between two whole ones, as two factors.
struct Between {
  explicit Between(double code) : low(static_cast<Eigen::Index>(code)), upper(code - static_cast<double>(low)) {}
  Eigen::Index low;
  double upper;
  [[nodiscard]] double of(const Eigen::VectorXd& values) const {
    return values[low] * (1 - upper) + values[low + 1] * upper;
  }
};

/// A patch tells the curve's rise from one of its codes to the next; its own light is eliminated.
void addPatch(Equations& sum, const PatchCodes& patch) {
  double weights = 0;
  double mean = 0;
  for (const auto& one : patch) {
    weights += weightOf(one.code);
    mean += weightOf(one.code) * one.logExposure;
  }
  mean /= weights;
  const auto factors = [](const PatchCode& one) {
    const Between at(one.code);
    return std::array{std::pair(at.low, 1 - at.upper), std::pair(at.low + 1, at.upper)};
  };
  for (const auto& a : patch) {
    for (const auto& [row, rowFactor] : factors(a)) {
      const double own = weightOf(a.code) * rowFactor;
      sum.right[row] += own * (a.logExposure - mean);
      for (const auto& [column, factor] : factors(a)) sum.matrix(row, column) += own * factor;
      for (const auto& b : patch) {
        for (const auto& [column, factor] : factors(b)) {
          sum.matrix(row, column) -= own * weightOf(b.code) * factor / weights;
        }
      }
    }
  }
  sum.weight += weights;
}

/// Square of the curve's second derivative over the logarithm of the shifted code: straight there are linear cameras
/// and power laws, so that smoothness does not bend them.
void addSmoothness(Equations& sum, double strength) {
  const auto place = [](Eigen::Index code) { return std::log(static_cast<double>(code) + kShift); };
  for (Eigen::Index i = 1; i < 255; ++i) {
    const double before = place(i) - place(i - 1);
    const double after = place(i + 1) - place(i);
    const std::array<double, 3> factors = {1 / before, -1 / before - 1 / after, 1 / after};
    const double weight = strength * 2 / (before + after);
    for (Eigen::Index a = 0; a < 3; ++a) {
      for (Eigen::Index b = 0; b < 3; ++b) {
        sum.matrix(i - 1 + a, i - 1 + b) +=
            weight * factors.at(static_cast<std::size_t>(a)) * factors.at(static_cast<std::size_t>(b));
      }
    }
  }
}

/// Logarithm of light for every code, from every `step`th patch.
Eigen::VectorXd solve(const std::vector<PatchCodes>& patches, double smoothness, std::size_t first = 0,
                      std::size_t step = 1) {
  Equations sum;
  for (std::size_t i = first; i < patches.size(); i += step) addPatch(sum, patches[i]);
  addSmoothness(sum, smoothness * sum.weight);
  sum.matrix(128, 128) += sum.weight;  // the scale is free: light of code 128 is one
  Eigen::VectorXd curve = sum.matrix.ldlt().solve(sum.right);
  levelFalls({curve.data(), 256});
  return curve;
}

/// Relative disagreement of the patches with the curve, RMS.
double residualOf(const std::vector<PatchCodes>& patches, const Eigen::VectorXd& curve) {
  double sum = 0;
  double count = 0;
  for (const auto& patch : patches) {
    double light = 0;
    double weights = 0;
    for (const auto& one : patch) {
      light += weightOf(one.code) * (Between(one.code).of(curve) - one.logExposure);
      weights += weightOf(one.code);
    }
    for (const auto& one : patch) {
      if (one.code < 20 || one.code > 235) continue;
      sum += std::pow(Between(one.code).of(curve) - one.logExposure - light / weights, 2);
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

/// RMS difference of two curves, scales apart, over the codes that matter.
double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::ArrayXd off = (a - b).segment(20, 216).array();
  return std::sqrt((off - off.mean()).square().mean());
}

/// Noise shows between the halves of the patches, bends that smoothness does not follow where it is stronger.
double errorOf(const std::vector<PatchCodes>& patches, const Eigen::VectorXd& curve) {
  const double noise = 0.5 * difference(solve(patches, kSmoothness, 0, 2), solve(patches, kSmoothness, 1, 2));
  return std::hypot(noise, difference(curve, solve(patches, 10 * kSmoothness)));
}

void checkRange(const std::vector<PatchCodes>& patches, std::string_view channel) {
  std::vector<double> codes = {20, 235};
  for (const auto& patch : patches) {
    for (const auto& one : patch) codes.push_back(one.code);
  }
  std::ranges::sort(codes);
  for (std::size_t i = 0; i + 1 < codes.size(); ++i) {
    if (codes[i + 1] - codes[i] <= kLargestGap) continue;
    throw EstimateError("the exposure series has no even " + std::string(channel) + " parts between codes " +
                        std::to_string(std::lround(codes[i])) + " and " + std::to_string(std::lround(codes[i + 1])) +
                        ": take it from too dark to too bright, in finer steps, of a scene with bright and dark parts");
  }
}

Curve lightOf(const Eigen::VectorXd& logarithm) {
  Curve light{};
  for (std::size_t code = 1; code < 256; ++code) {
    light.at(code) = std::exp(logarithm[static_cast<Eigen::Index>(code)] - logarithm[255]);
  }
  return light;
}

}  // namespace

CameraResponse linearCamera() {
  CameraResponse camera;
  for (auto& light : camera.light) {
    for (std::size_t code = 0; code < 256; ++code) light.at(code) = static_cast<double>(code) / 255;
  }
  return camera;
}

CameraResponse estimateCameraResponse(std::span<const ExposedPhoto> photos) {
  std::vector<ExposedPhoto> series(photos.begin(), photos.end());
  std::ranges::stable_sort(series, {}, &ExposedPhoto::exposure);
  checkSeries(series);
  checkOrder(series);
  CameraResponse camera;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto patches = collectPatches(series, static_cast<int>(c));
    checkRange(patches, kChannels.at(c));
    const Eigen::VectorXd curve = solve(patches, kSmoothness);
    camera.residual = std::max(camera.residual, residualOf(patches, curve));
    camera.error = std::max(camera.error, errorOf(patches, curve));
    camera.light.at(c) = lightOf(curve);
  }
  if (camera.residual > kLargestResidual) {
    throw EstimateError("the exposure series contradicts itself by " +
                        std::to_string(std::lround(100 * camera.residual)) +
                        " %: the light changed, something moved, or the exposures are not those stated");
  }
  return camera;
}

}  // namespace pixelflex::calib
