#include "calib/photometric/smooth_bound.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace pixelflex::calib {
namespace {

using devices::ImageF;

constexpr float kOutside = std::numeric_limits<float>::max();
constexpr int kRounding = 2;  // pixels, each way; twice

/// Logarithms; kOutside where there is no field.
ImageF logOf(const ImageF& field, float sign) {
  ImageF log = field;
  for (float& value : log.samples()) value = value > 0 ? sign * std::log(value) : kOutside;
  return log;
}

/// value = min over all pixels of (value there + slope * distance), the distance counted in steps to the eight
/// neighbours. One sweep down and one up find it exactly.
void boundSlope(ImageF& log, float slope) {
  const auto diagonal = slope * std::numbers::sqrt2_v<float>;
  const auto lower = [&](int x, int y, int fromX, int fromY, float step) {
    if (fromX < 0 || fromX >= log.width() || fromY < 0 || fromY >= log.height()) return;
    if (log.at(fromX, fromY) != kOutside) log.at(x, y) = std::min(log.at(x, y), log.at(fromX, fromY) + step);
  };
  const auto sweep = [&](int x, int y, int direction) {
    lower(x, y, x - direction, y, slope);
    lower(x, y, x, y - direction, slope);
    lower(x, y, x - 1, y - direction, diagonal);
    lower(x, y, x + 1, y - direction, diagonal);
  };
  for (int y = 0; y < log.height(); ++y) {
    for (int x = 0; x < log.width(); ++x) sweep(x, y, 1);
  }
  for (int y = log.height() - 1; y >= 0; --y) {
    for (int x = log.width() - 1; x >= 0; --x) sweep(x, y, -1);
  }
}

/// Runs `line`, which changes a row or column in place, over all rows and then all columns.
template <class Line>
void eachWay(ImageF& image, const Line& line) {
  std::vector<float> values;
  const auto run = [&](int count, auto&& sample) {
    values.resize(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) values[static_cast<std::size_t>(i)] = sample(i);
    line(values);
    for (int i = 0; i < count; ++i) sample(i) = values[static_cast<std::size_t>(i)];
  };
  for (int y = 0; y < image.height(); ++y) {
    run(image.width(), [&](int x) -> float& { return image.at(x, y); });
  }
  for (int x = 0; x < image.width(); ++x) {
    run(image.height(), [&](int y) -> float& { return image.at(x, y); });
  }
}

/// Folds an index back at the ends of a line: -1 is 0, count is count - 1.
std::size_t mirrored(std::ptrdiff_t i, std::ptrdiff_t count) {
  const std::ptrdiff_t period = 2 * count;
  i = ((i % period) + period) % period;
  return static_cast<std::size_t>(i < count ? i : period - 1 - i);
}

/// Each value becomes `combine` of the window around it.
template <class Combine>
void overWindow(std::vector<float>& line, int reach, const Combine& combine) {
  const std::vector<float> from = line;
  const auto count = static_cast<std::ptrdiff_t>(from.size());
  std::vector<float> window(static_cast<std::size_t>(2 * reach + 1));
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
      window[static_cast<std::size_t>(k + reach)] = from[mirrored(i + k, count)];
    }
    line[static_cast<std::size_t>(i)] = combine(window);
  }
}

float meanOf(const std::vector<float>& window) {
  double sum = 0;
  for (const float value : window) sum += value;
  return static_cast<float>(sum / static_cast<double>(window.size()));
}

/// Two box averages of the least value in their reach: rounder than before, and never higher.
void roundBends(ImageF& log) {
  eachWay(log, [](std::vector<float>& line) {
    overWindow(line, 2 * kRounding, [](const auto& window) { return *std::ranges::min_element(window); });
  });
  for (int pass = 0; pass < 2; ++pass) {
    eachWay(log, [](std::vector<float>& line) { overWindow(line, kRounding, meanOf); });
  }
}

ImageF bounded(const ImageF& field, double gradient, float sign) {
  assert(field.channels() == 1 && gradient >= 0);
  ImageF log = logOf(field, sign);
  if (std::ranges::all_of(log.samples(), [](float value) { return value == kOutside; })) return ImageF(field.size(), 1);
  // Steps to eight neighbours bound slopes in those directions; between them a slope may be 1 / cos 22.5 degrees more.
  boundSlope(log, static_cast<float>(gradient * std::cos(std::numbers::pi / 8)));
  roundBends(log);
  for (std::size_t i = 0; i < log.samples().size(); ++i) {
    float& value = log.samples()[i];
    value = field.samples()[i] > 0 ? std::exp(sign * value) : 0;
  }
  return log;
}

}  // namespace

ImageF smoothBelow(const ImageF& field, double gradient) {
  return bounded(field, gradient, 1);
}

ImageF smoothAbove(const ImageF& field, double gradient) {
  return bounded(field, gradient, -1);
}

}  // namespace pixelflex::calib
