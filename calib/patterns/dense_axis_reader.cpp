#include "calib/patterns/dense_axis_reader.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pixelflex::calib {
namespace {

constexpr float kLeastWave = 0.08F;  // amplitude over white; sharp it is 0.42
constexpr float kLeastWaveCodes = 0.8F;
constexpr float kMostRest = 0.08F;         // what is no wave, RMS over white
constexpr float kRestCodes = 1.5F;         // likewise, from noise
constexpr float kTossUp = 0.15F;           // a bit so close to one half may be either
constexpr float kMostDisagreement = 0.4F;  // of the period, between wave and the middle of the coded cell

}  // namespace

void WaveOffsets::add(float offset) {
  const int bin = static_cast<int>(std::floor((offset + 0.5F) * kBins));
  ++bins_.at(static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1)));
}

WaveOffsets& WaveOffsets::operator+=(const WaveOffsets& other) {
  for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += other.bins_[i];
  return *this;
}

double WaveOffsets::mean() const {
  double byCosine = 0, bySine = 0;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    const double angle = 2 * std::numbers::pi * ((static_cast<double>(i) + 0.5) / kBins - 0.5);
    byCosine += static_cast<double>(bins_[i]) * std::cos(angle);
    bySine += static_cast<double>(bins_[i]) * std::sin(angle);
  }
  return std::atan2(bySine, byCosine) / (2 * std::numbers::pi);
}

AxisReader::AxisReader(const DenseAxis& axis, std::size_t firstCode, std::size_t firstWave)
    : axis_(axis), firstCode_(firstCode), firstWave_(firstWave) {
  for (std::size_t i = 0; i < kPhaseSteps; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kPhaseSteps;
    cosine_.at(i) = static_cast<float>(std::cos(angle));
    sine_.at(i) = static_cast<float>(std::sin(angle));
  }
}

Reading AxisReader::read(const PixelCodes& codes, float black, float range, float& position) {
  float turns = 0;
  const Reading wave = readWave(codes, range, turns);
  if (wave != Reading::kKnown) return wave;
  const std::optional<int> cell = readCell(codes, black, range);
  if (!cell) return Reading::kContradicting;
  const auto period = static_cast<float>(axis_.period());
  const float middle = (static_cast<float>(*cell) + 0.5F) / 2;  // in periods
  const float offset = turns - middle - std::round(turns - middle);
  offsets_.add(offset);
  position = period * (middle + offset);
  const bool inFrame = position > -period && position < static_cast<float>(axis_.length()) + period;
  return inFrame && std::abs(offset) <= kMostDisagreement ? Reading::kKnown : Reading::kContradicting;
}

Reading AxisReader::readWave(const PixelCodes& codes, float range, float& turns) const {
  float mean = 0, square = 0, byCosine = 0, bySine = 0;
  for (std::size_t i = 0; i < kPhaseSteps; ++i) {
    const float code = codes.at(firstWave_ + i);
    mean += code / kPhaseSteps;
    square += code * code / kPhaseSteps;
    byCosine += code * cosine_[i] * 2 / kPhaseSteps;
    bySine += code * sine_[i] * 2 / kPhaseSteps;
  }
  const float power = byCosine * byCosine + bySine * bySine;
  const float least = std::max(kLeastWave * range, 3 * kLeastWaveCodes);
  if (power < least * least) return Reading::kFaint;
  const float rest = square - mean * mean - power / 2;
  const float mostRest = kMostRest * range + 3 * kRestCodes;
  if (rest > mostRest * mostRest) return Reading::kContradicting;
  turns = std::atan2(bySine, byCosine) / (2 * std::numbers::pi_v<float>);
  return Reading::kKnown;
}

/// Along a Gray code at most one bit is undecided, and the wave decides between the two cells.
std::optional<int> AxisReader::readCell(const PixelCodes& codes, float black, float range) const {
  int binary = 0;
  int undecided = 0;
  for (int bit = 0; bit < axis_.bits(); ++bit) {
    const float light = (codes.at(firstCode_ + static_cast<std::size_t>(bit)) - black) / range;
    if (std::abs(light - 0.5F) < kTossUp) ++undecided;
    const int gray = light > 0.5F ? 1 : 0;
    binary = 2 * binary + (gray ^ (binary & 1));
  }
  return undecided > 1 ? std::nullopt : std::optional(binary);
}

}  // namespace pixelflex::calib
