#include "tests/accuracy/light_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "calib/photometric/colour_difference.h"
#include "calib/simulate/blur.h"

namespace pixelflex::calib {
namespace {

using devices::ImageF;

constexpr double kProfileFrom = 4;  // desktop pixels
constexpr double kProfileTo = 28;

/// Bilinear between centres of pixels; none outside them.
std::optional<double> valueAt(const ImageF& image, glm::dvec2 at) {
  const glm::dvec2 p = at - 0.5;
  const int x = static_cast<int>(std::floor(p.x));
  const int y = static_cast<int>(std::floor(p.y));
  if (x < 0 || y < 0 || x + 1 >= image.width() || y + 1 >= image.height()) return std::nullopt;
  const double right = p.x - x;
  const double below = p.y - y;
  return (1 - below) * ((1 - right) * image.at(x, y) + right * image.at(x + 1, y)) +
         below * ((1 - right) * image.at(x, y + 1) + right * image.at(x + 1, y + 1));
}

std::optional<double> alongStretch(const ImageF& image, const BorderStretch& stretch, double outward) {
  double sum = 0;
  for (std::size_t i = 0; i < stretch.at.size(); ++i) {
    const auto value = valueAt(image, stretch.at[i] + outward * stretch.outward[i]);
    if (!value) return std::nullopt;
    sum += *value;
  }
  return sum / static_cast<double>(stretch.at.size());
}

/// Least squares of level + slope * s + step * sign(s) / 2 over a profile that is symmetrical about 0.
std::optional<double> stepOf(const WallView& view, const ImageF& image, const BorderStretch& stretch) {
  double count = 0, level = 0, square = 0, absolute = 0, bySlope = 0, byStep = 0;
  for (double s = kProfileFrom / view.scale(); s <= kProfileTo / view.scale(); ++s) {
    const auto inside = alongStretch(image, stretch, -s);
    const auto outside = alongStretch(image, stretch, s);
    if (!inside || !outside) return std::nullopt;
    count += 2;
    level += *inside + *outside;
    square += 2 * s * s;
    absolute += s;
    bySlope += s * (*outside - *inside);
    byStep += 0.5 * (*outside - *inside);
  }
  const double determinant = square * count / 4 - absolute * absolute;
  return (square * byStep - absolute * bySlope) / determinant / (level / count);
}

double blockMean(const ImageF& image, const WallBlock& block, int channel = 0) {
  double sum = 0;
  for (int k = 0; k < kBlockPixels * kBlockPixels; ++k) {
    sum += image.at(block.x + k % kBlockPixels, block.y + k / kBlockPixels, channel);
  }
  return sum / (kBlockPixels * kBlockPixels);
}

ImageF smoothed(const ImageF& image, double sigma) {
  ImageF smooth = image;
  blur(smooth, gaussianKernel(sigma * sigma));
  return smooth;
}

struct Moments {
  double count = 0, sum = 0, squares = 0;
  void add(double value) {
    ++count;
    sum += value;
    squares += value * value;
  }
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double deviation() const {
    return count > 0 ? std::sqrt(std::max(0.0, squares / count - mean() * mean())) : 0;
  }
};

}  // namespace

BorderStep largestStep(const WallView& view, const ImageF& luminance) {
  BorderStep largest;
  for (const auto& stretch : view.borders()) {
    const double step = std::abs(stepOf(view, luminance, stretch).value_or(0));
    if (step > largest.step) largest = {step, stretch.at[stretch.at.size() / 2], stretch.projector};
  }
  return largest;
}

double unevenness(const ImageF& luminance) {
  Moments all;
  for (const float value : luminance.samples()) all.add(value);
  return all.deviation() / all.mean();
}

SteepPlace steepestPerDegree(const WallView& view, const ImageF& luminance) {
  const double degree = view.pixelsPerDegree();
  const ImageF smooth = smoothed(luminance, degree / 8);
  constexpr double kStep = 4;
  SteepPlace steepest;
  for (double y = 0; y < luminance.height(); y += kStep) {
    for (double x = 0; x < luminance.width(); x += kStep) {
      const auto left = valueAt(smooth, {x - degree / 2, y}), right = valueAt(smooth, {x + degree / 2, y});
      const auto above = valueAt(smooth, {x, y - degree / 2}), below = valueAt(smooth, {x, y + degree / 2});
      if (!left || !right || !above || !below) continue;
      const double mean = (*left + *right + *above + *below) / 4;
      const double change = std::hypot(*right - *left, *below - *above) / mean;
      if (change > steepest.change) steepest = {change, {x, y}};
    }
  }
  return steepest;
}

double blackStep(const WallView& view, const ImageF& luminance) {
  std::map<int, Moments> byCount;
  for (const auto& block : view.blocks()) {
    if (!block.nearBorder) byCount[block.lit].add(blockMean(luminance, block));
  }
  double largest = 0;
  for (const auto& [count, light] : byCount) {
    largest = std::max(largest, std::abs(light.mean() / byCount.begin()->second.mean() - 1));
  }
  return largest;
}

double banding(const WallView& view, const GreyBetween& luminance) {
  constexpr double kSmooth = 16;  // desktop pixels: black and white without the noise of their own codes
  const ImageF black = smoothed(luminance.black, kSmooth / view.scale());
  const ImageF white = smoothed(luminance.white, kSmooth / view.scale());
  Moments errors;
  for (const auto& block : view.blocks()) {
    if (block.nearBorder || block.lit < 2) continue;
    for (int k = 0; k < kBlockPixels * kBlockPixels; ++k) {
      const int x = block.x + k % kBlockPixels;
      const int y = block.y + k / kBlockPixels;
      const double expected = black.at(x, y) + luminance.light * (white.at(x, y) - black.at(x, y));
      errors.add(luminance.grey.at(x, y) / expected - 1);
    }
  }
  return errors.deviation();
}

glm::dvec3 colourOfProjector(const WallView& view, const ImageF& light, std::size_t projector) {
  std::array<Moments, 3> channels;
  for (const auto& block : view.blocks()) {
    if (((block.central >> projector) & 1U) == 0) continue;
    for (int c = 0; c < 3; ++c) channels.at(static_cast<std::size_t>(c)).add(blockMean(light, block, c));
  }
  return {channels[0].mean(), channels[1].mean(), channels[2].mean()};
}

glm::dvec3 meanColour(const ImageF& light) {
  glm::dvec3 sum(0);
  const auto samples = light.samples();
  for (std::size_t i = 0; i < samples.size(); i += 3) sum += glm::dvec3(samples[i], samples[i + 1], samples[i + 2]);
  return sum / static_cast<double>(light.size().area());
}

double colourDifference(const std::vector<glm::dvec3>& colours, glm::dvec3 white) {
  double squares = 0, pairs = 0;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    for (std::size_t j = i + 1; j < colours.size(); ++j) {
      const double difference =
          deltaE2000(labFromLinearSrgb(colours[i] / white), labFromLinearSrgb(colours[j] / white));
      squares += difference * difference;
      ++pairs;
    }
  }
  return pairs > 0 ? std::sqrt(squares / pairs) : 0;
}

}  // namespace pixelflex::calib
