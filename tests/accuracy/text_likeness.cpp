#include "tests/accuracy/text_likeness.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "calib/simulate/blur.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::ImageF;

constexpr int kReach = 5;
constexpr double kSigma = 1.5;

std::vector<float> window() {
  std::vector<double> half;
  double sum = 0;
  for (int i = 0; i <= kReach; ++i) {
    half.push_back(std::exp(-i * i / (2 * kSigma * kSigma)));
    sum += half.back() * (i == 0 ? 1 : 2);
  }
  std::vector<float> kernel;
  for (const double weight : half) kernel.push_back(static_cast<float>(weight / sum));
  return kernel;
}

ImageF meanOfProduct(const ImageF& first, const ImageF& second) {
  ImageF product(first.size(), 1);
  std::ranges::transform(first.samples(), second.samples(), product.samples().begin(), std::multiplies<>());
  blur(product, window());
  return product;
}

ImageF meanOf(ImageF image) {
  blur(image, window());
  return image;
}

float codeOf(double light) {
  const double held = std::clamp(light, 0.0, 1.0);
  return static_cast<float>(255 * (held <= 0.0031308 ? 12.92 * held : 1.055 * std::pow(held, 1 / 2.4) - 0.055));
}

}  // namespace

Image8 textDesktop(const Image8& text, devices::Size size) {
  Image8 desktop(size, 4);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      for (int c = 0; c < 3; ++c) desktop.at(x, y, c) = text.at(x % text.width(), y % text.height());
      desktop.at(x, y, 3) = 255;
    }
  }
  return desktop;
}

double structuralSimilarity(const ImageF& first, const ImageF& second) {
  assert(first.size() == second.size() && first.channels() == 1 && second.channels() == 1);
  constexpr double kMeans = 0.01 * 255 * 0.01 * 255;
  constexpr double kDeviations = 0.03 * 255 * 0.03 * 255;
  const ImageF mean1 = meanOf(first), mean2 = meanOf(second);
  const ImageF square1 = meanOfProduct(first, first), square2 = meanOfProduct(second, second);
  const ImageF product = meanOfProduct(first, second);
  double sum = 0, count = 0;
  for (int y = kReach; y < first.height() - kReach; ++y) {
    for (int x = kReach; x < first.width() - kReach; ++x) {
      const double a = mean1.at(x, y), b = mean2.at(x, y);
      const double variances = square1.at(x, y) - a * a + square2.at(x, y) - b * b;
      const double covariance = product.at(x, y) - a * b;
      sum += (2 * a * b + kMeans) * (2 * covariance + kDeviations) /
             ((a * a + b * b + kMeans) * (variances + kDeviations));
      ++count;
    }
  }
  return sum / count;
}

double likenessToDesktop(const ImageF& luminance, double white, const Image8& desktop) {
  ImageF seen(luminance.size(), 1);
  ImageF ideal(desktop.size(), 1);
  std::ranges::transform(luminance.samples(), seen.samples().begin(), [&](float l) { return codeOf(l / white); });
  for (int y = 0; y < ideal.height(); ++y) {
    for (int x = 0; x < ideal.width(); ++x) ideal.at(x, y) = desktop.at(x, y);
  }
  return structuralSimilarity(seen, ideal);
}

}  // namespace pixelflex::calib
