#include "calib/estimate/exposure_merge.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace pixelflex::calib {
namespace {

constexpr std::uint8_t kClippedCode = 250;

double weightOf(int code) {
  constexpr double kRamp = 10;  // codes: no step in the result where a photograph comes into range
  return std::clamp(std::min(code - kDarkestCode + 1, kBrightestCode + 1 - code) / kRamp, 0.0, 1.0);
}

/// By rising exposure.
std::vector<const ExposedPhoto*> ordered(std::span<const ExposedPhoto> photos) {
  assert(!photos.empty());
  std::vector<const ExposedPhoto*> order;
  for (const auto& one : photos) {
    assert(one.photo.channels() == 3 && one.photo.size() == photos[0].photo.size() && one.exposure > 0);
    order.push_back(&one);
  }
  std::ranges::stable_sort(order, {}, &ExposedPhoto::exposure);
  return order;
}

/// Weights and light of every code, looked up once.
struct CodeTable {
  std::array<double, 256> weight{};
  std::array<double, 256> weightedLight{};
};

CodeTable tableOf(const std::array<double, 256>& light) {
  CodeTable table;
  for (std::size_t code = 0; code < 256; ++code) {
    table.weight.at(code) = weightOf(static_cast<int>(code));
    table.weightedLight.at(code) = table.weight.at(code) * light.at(code);
  }
  return table;
}

/// None holds sample `i` in range: the longest that is not too bright tells.
double lightOutOfRange(const std::vector<const ExposedPhoto*>& photos, std::size_t i,
                       const std::array<double, 256>& light) {
  const ExposedPhoto* best = photos.front();
  for (const auto* one : photos) {
    if (one->photo.samples()[i] <= kBrightestCode) best = one;
  }
  return light.at(best->photo.samples()[i]) / best->exposure;
}

/// What rounding to whole codes may do to the mean over a patch: the less the finer its spread in codes, which lets
/// rounding go either way. Of the longest exposure, which tells most.
double roundingDeviation(const ExposedPhoto& photo, std::size_t channel, const std::array<double, 256>& light) {
  double mean = 0;
  double square = 0;
  const auto pixels = static_cast<double>(photo.photo.size().area());
  for (std::size_t i = channel; i < photo.photo.samples().size(); i += 3) {
    const double code = photo.photo.samples()[i];
    mean += code / pixels;
    square += code * code / pixels;
  }
  const double variance = std::max(0.0, square - mean * mean);
  const auto below = static_cast<std::size_t>(std::clamp(mean, 0.0, 254.0));
  const double lightOfCode = (light.at(below + 1) - light.at(below)) / photo.exposure;
  return 0.29 * std::exp(-2 * std::numbers::pi * std::numbers::pi * variance) * lightOfCode;
}

/// The longest exposure that is not too bright on the whole.
const ExposedPhoto& tellingMost(const std::vector<const ExposedPhoto*>& order) {
  const ExposedPhoto* best = order.front();
  for (const auto* one : order) {
    const auto bright = std::ranges::count_if(one->photo.samples(), [](auto code) { return code > kBrightestCode; });
    if (10 * static_cast<std::size_t>(bright) < one->photo.samples().size()) best = one;
  }
  return *best;
}

}  // namespace

devices::ImageF mergeExposures(std::span<const ExposedPhoto> photos, const CameraResponse& camera) {
  const auto order = ordered(photos);
  devices::ImageF merged(order.front()->photo.size(), 3);
  std::array<CodeTable, 3> tables;
  for (std::size_t c = 0; c < 3; ++c) tables.at(c) = tableOf(camera.light.at(c));
  for (std::size_t i = 0; i < merged.samples().size(); ++i) {
    const CodeTable& table = tables[i % 3];
    double light = 0;
    double exposure = 0;
    for (const auto* one : order) {
      const std::uint8_t code = one->photo.samples()[i];
      light += table.weightedLight[code];
      exposure += table.weight[code] * one->exposure;
    }
    merged.samples()[i] =
        static_cast<float>(exposure > 0 ? light / exposure : lightOutOfRange(order, i, camera.light[i % 3]));
  }
  return merged;
}

PatchLight patchLight(std::span<const ExposedPhoto> photos, const CameraResponse& camera) {
  const devices::ImageF merged = mergeExposures(photos, camera);
  const auto order = ordered(photos);
  const devices::Image8& shortest = order.front()->photo;
  const auto pixels = static_cast<double>(merged.size().area());
  PatchLight patch;
  std::array<double, 3> squares{};
  for (std::size_t i = 0; i < merged.samples().size(); ++i) {
    const double light = merged.samples()[i];
    patch.light.at(i % 3) += light / pixels;
    squares.at(i % 3) += light * light / pixels;
    if (shortest.samples()[i] >= kClippedCode) patch.clipped += 1 / (3 * pixels);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const double variance = std::max(0.0, squares.at(c) - patch.light.at(c) * patch.light.at(c));
    patch.deviation.at(c) =
        std::hypot(std::sqrt(variance / pixels), roundingDeviation(tellingMost(order), c, camera.light.at(c)));
  }
  return patch;
}

}  // namespace pixelflex::calib
