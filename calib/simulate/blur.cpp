#include "calib/simulate/blur.h"

#include <algorithm>
#include <cmath>

#include "calib/simulate/parallel.h"

namespace pixelflex::calib {

namespace {

using devices::ImageF;

std::vector<double> sampledGaussian(double sigma, int radius) {
  std::vector<double> half(static_cast<std::size_t>(radius) + 1);
  double sum = 0;
  for (int i = 0; i <= radius; ++i) {
    half[static_cast<std::size_t>(i)] = std::exp(-0.5 * i * i / (sigma * sigma));
    sum += (i == 0 ? 1 : 2) * half[static_cast<std::size_t>(i)];
  }
  for (double& weight : half) weight /= sum;
  return half;
}

double varianceOf(const std::vector<double>& half) {
  double variance = 0;
  for (std::size_t i = 1; i < half.size(); ++i) variance += 2 * half[i] * static_cast<double>(i * i);
  return variance;
}

void blurRow(const float* from, float* to, std::size_t pixels, std::size_t channels, const std::vector<float>& kernel) {
  const std::size_t radius = kernel.size() - 1;
  std::vector<float> padded((pixels + 2 * radius) * channels);
  std::copy_n(from, pixels * channels, padded.begin() + static_cast<std::ptrdiff_t>(radius * channels));
  for (std::size_t i = 0; i < radius * channels; ++i) {
    padded[i] = from[i % channels];
    padded[(pixels + radius) * channels + i] = from[(pixels - 1) * channels + i % channels];
  }
  const float* middle = padded.data() + radius * channels;
  const std::size_t count = pixels * channels;
  for (std::size_t i = 0; i < count; ++i) to[i] = kernel[0] * middle[i];
  for (std::size_t tap = 1; tap <= radius; ++tap) {
    const float weight = kernel[tap];
    const float* left = middle - tap * channels;
    const float* right = middle + tap * channels;
    for (std::size_t i = 0; i < count; ++i) to[i] += weight * (left[i] + right[i]);
  }
}

void blurColumn(const ImageF& from, ImageF& to, int y, const std::vector<float>& kernel) {
  const int last = from.height() - 1;
  float* out = to.row(y).data();
  const float* middle = from.row(y).data();
  const std::size_t count = from.row(y).size();
  for (std::size_t i = 0; i < count; ++i) out[i] = kernel[0] * middle[i];
  for (std::size_t tap = 1; tap < kernel.size(); ++tap) {
    const float weight = kernel[tap];
    const float* above = from.row(std::max(0, y - static_cast<int>(tap))).data();
    const float* below = from.row(std::min(last, y + static_cast<int>(tap))).data();
    for (std::size_t i = 0; i < count; ++i) out[i] += weight * (above[i] + below[i]);
  }
}

}  // namespace

std::vector<float> gaussianKernel(double variance) {
  if (variance <= 1e-9) return {1.0F};
  const int radius = std::max(2, static_cast<int>(std::ceil(4 * std::sqrt(variance))));
  double low = 0.01;
  double high = 2 * std::sqrt(variance) + 1;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (varianceOf(sampledGaussian(middle, radius)) < variance ? low : high) = middle;
  }
  const auto half = sampledGaussian(high, radius);
  return {half.begin(), half.end()};
}

void blur(ImageF& image, const std::vector<float>& kernel) {
  if (kernel.size() < 2 || image.empty()) return;
  ImageF rows(image.size(), image.channels());
  const auto pixels = static_cast<std::size_t>(image.width());
  const auto channels = static_cast<std::size_t>(image.channels());
  inTwoHalves(image.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) blurRow(image.row(y).data(), rows.row(y).data(), pixels, channels, kernel);
  });
  inTwoHalves(image.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) blurColumn(rows, image, y, kernel);
  });
}

}  // namespace pixelflex::calib
