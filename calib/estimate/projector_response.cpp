#include "calib/estimate/projector_response.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <string_view>

#include "calib/photometric/monotone.h"

namespace pixelflex::calib {
namespace {

constexpr std::size_t kFewestLevels = 5;
constexpr double kMostClipped = 0.01;  // of the patch
constexpr double kFloor = 0.01;        // of white: errors are relative to light, but not below
constexpr std::array<std::string_view, 3> kChannels = {"red", "green", "blue"};

/// Light of one channel over code, 1 at code 255.
struct Measured {
  std::vector<double> code;
  std::vector<double> light;
  std::vector<double> deviation;
};

std::string placeOf(std::size_t channel, int code) {
  return std::string(kChannels.at(channel)) + " level " + std::to_string(code);
}

void checkLevels(const std::vector<LevelLight>& levels, std::size_t channel) {
  const bool rising =
      std::ranges::adjacent_find(levels, std::ranges::greater_equal{}, &LevelLight::code) == levels.end();
  if (levels.size() < kFewestLevels || !rising || levels.front().code < 1 || levels.back().code != 255) {
    throw EstimateError("the response of " + std::string(kChannels.at(channel)) +
                        " needs five levels or more, rising to 255: photograph the missing ones");
  }
  for (const auto& level : levels) {
    if (level.patch.clipped > kMostClipped) {
      throw LevelError(static_cast<int>(channel), level.code,
                       placeOf(channel, level.code) + " is over-exposed: add shorter exposures");
    }
  }
}

/// What each of the camera's channels tells about the projector's: the square of signal to noise.
std::array<double, 3> trustOf(const std::vector<LevelLight>& levels, const PatchLight& black) {
  std::array<double, 3> trust{};
  const PatchLight& white = levels.back().patch;
  for (std::size_t c = 0; c < 3; ++c) {
    const double signal = white.light.at(c) - black.light.at(c);
    double noise = 1e-5 * white.light.at(c);
    for (const auto& level : levels) noise = std::max(noise, level.patch.deviation.at(c));
    if (signal > 0) trust.at(c) = std::pow(signal / noise, 2);
  }
  return trust;
}

/// Light above black over white above black, with black itself as code 0.
Measured measure(const ResponseSeries& series, std::size_t channel) {
  const auto& levels = series.levels.at(channel);
  const auto trust = trustOf(levels, series.black);
  const double sum = trust[0] + trust[1] + trust[2];
  if (!(sum > 100)) {
    throw LevelError(static_cast<int>(channel), 255,
                     "full " + std::string(kChannels.at(channel)) +
                         " is no brighter than black: check that the projector shows the patterns");
  }
  Measured measured{.code = {0}, .light = {0}, .deviation = {0}};
  for (const auto& level : levels) {
    double light = 0;
    double variance = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(trust.at(c) > 0)) continue;
      const double white = levels.back().patch.light.at(c) - series.black.light.at(c);
      const double part = trust.at(c) / sum / white;
      light += part * (level.patch.light.at(c) - series.black.light.at(c));
      variance += part * part * (std::pow(level.patch.deviation.at(c), 2) + std::pow(series.black.deviation.at(c), 2));
    }
    measured.code.push_back(level.code);
    measured.light.push_back(light);
    measured.deviation.push_back(std::sqrt(variance));
  }
  return measured;
}

/// Refuses light that falls by more than noise does, where it falls most.
void checkFalls(const Measured& measured, const std::vector<double>& levelled, std::size_t channel) {
  double most = 1;
  std::size_t worst = 0;
  for (std::size_t i = 1; i < levelled.size(); ++i) {
    const double allowed = 0.005 + 0.05 * std::abs(levelled[i]) + 4 * measured.deviation[i];
    const double fall = std::abs(measured.light[i] - levelled[i]) / allowed;
    if (fall > most) worst = i;
    most = std::max(most, fall);
  }
  if (worst == 0) return;
  const int code = static_cast<int>(measured.code[worst]);
  throw LevelError(static_cast<int>(channel), code,
                   "light falls where codes rise, near " + placeOf(channel, code) +
                       ": photographs are mixed up, or the light changed between them");
}

/// Levels what falls by noise.
void level(Measured& measured, std::size_t channel) {
  std::vector<double> levelled = measured.light;
  levelFalls(levelled);
  checkFalls(measured, levelled, channel);
  const double black = std::max(0.0, levelled.front());
  const double range = levelled.back() - black;
  for (std::size_t i = 0; i < levelled.size(); ++i) {
    measured.light[i] = std::max(0.0, levelled[i] - black) / range;
    measured.deviation[i] /= range;
  }
}

/// Between levels in the square root, where responses are nearly straight.
std::vector<double> interpolated(const Measured& measured, std::span<const double> codes) {
  std::vector<double> roots;
  for (const double light : measured.light) roots.push_back(std::sqrt(light));
  auto values = interpolateMonotone(measured.code, roots, codes);
  for (double& value : values) value *= value;
  return values;
}

double relative(double error, double light) {
  return error / std::max(light, kFloor);
}

/// How far the curve would miss a level that was not there. A gap half as wide is missed by a quarter or less.
double gapError(const Measured& measured, std::size_t i) {
  Measured without = measured;
  const auto drop = [i](std::vector<double>& values) { values.erase(values.begin() + static_cast<std::ptrdiff_t>(i)); };
  drop(without.code);
  drop(without.light);
  return 0.25 * (interpolated(without, {&measured.code[i], 1}).front() - measured.light[i]);
}

double errorOf(const Measured& measured) {
  double squares = 0;
  double count = 0;
  const double white = measured.deviation.back();
  for (std::size_t i = 1; i + 1 < measured.code.size(); ++i) {
    if (measured.code[i] < 20 || measured.code[i] > 235) continue;
    const double light = measured.light[i];
    squares += std::pow(relative(measured.deviation[i], light), 2) + std::pow(relative(white * light, light), 2) +
               std::pow(relative(gapError(measured, i), light), 2);
    ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : 1;
}

/// Black without the ambient light, over the white of all three channels.
double leakOf(const ResponseSeries& series, const PatchLight& ambient) {
  double leak = 0;
  double channels = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    double white = 0;
    for (const auto& levels : series.levels) white += levels.back().patch.light.at(c) - series.black.light.at(c);
    if (!(white > 0)) continue;
    leak += (series.black.light.at(c) - ambient.light.at(c)) / white;
    ++channels;
  }
  return channels > 0 ? std::max(0.0, leak / channels) : 0;
}

}  // namespace

ProjectorResponse projectorResponse(const ResponseSeries& series) {
  std::array<double, 256> codes{};
  std::iota(codes.begin(), codes.end(), 0.0);
  ProjectorResponse response;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    checkLevels(series.levels.at(channel), channel);
    Measured measured = measure(series, channel);
    level(measured, channel);
    std::ranges::copy(interpolated(measured, codes), response.curve.light.at(channel).begin());
    response.error.at(channel) = errorOf(measured);
  }
  if (series.ambient) response.leak = leakOf(series, *series.ambient);
  return response;
}

}  // namespace pixelflex::calib
