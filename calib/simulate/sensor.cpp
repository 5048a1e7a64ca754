#include "calib/simulate/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "calib/simulate/parallel.h"
#include "calib/simulate/random.h"

namespace pixelflex::calib {

namespace {

constexpr std::size_t kTableBits = 14;
constexpr std::size_t kTableSize = std::size_t{1} << kTableBits;

/// Equally likely values of a normal variable: an index drawn evenly draws noise with one load.
std::vector<float> makeNormalTable() {
  std::vector<double> values(kTableSize);
  double x = -4;
  double square = 0;
  for (std::size_t i = 0; i < kTableSize; ++i) {
    const double wanted = (static_cast<double>(i) + 0.5) / static_cast<double>(kTableSize);
    for (int step = 0; step < 8; ++step) {  // Newton's iteration from the neighbour
      const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * 3.14159265358979323846);
      x += std::clamp((wanted - 0.5 * std::erfc(-x / std::sqrt(2.0))) / density, -0.5, 0.5);
    }
    values[i] = x;
    square += x * x / static_cast<double>(kTableSize);
  }
  std::vector<float> table(kTableSize);
  std::ranges::transform(values, table.begin(), [&](double v) { return static_cast<float>(v / std::sqrt(square)); });
  return table;
}

const std::vector<float>& normalTable() {
  static const std::vector<float> table = makeNormalTable();
  return table;
}

constexpr std::size_t kCurveSteps = 8192;

/// Codes of kCurveSteps + 1 levels of light.
std::vector<std::uint8_t> makeCurve(double gamma) {
  std::vector<std::uint8_t> curve(kCurveSteps + 1);
  for (std::size_t i = 0; i <= kCurveSteps; ++i) {
    const double light = static_cast<double>(i) / static_cast<double>(kCurveSteps);
    curve[i] = static_cast<std::uint8_t>(std::lround(255 * std::pow(light, 1 / gamma)));
  }
  return curve;
}

struct Noise {
  float perElectron;  // of full scale squared: shot variance is signal times this
  float read;         // of full scale squared
};

/// In place: part of full scale with noise added. Four draws from each random number.
void addNoise(std::vector<float>& line, Noise noise, Random random) {
  const float* table = normalTable().data();
  for (std::size_t i = 0; i < line.size(); i += 4) {
    const std::uint64_t bits = random.next();
    const std::size_t count = std::min<std::size_t>(4, line.size() - i);
    for (std::size_t k = 0; k < count; ++k) {
      const float deviation = std::sqrt(std::max(0.0F, line[i + k]) * noise.perElectron + noise.read);
      line[i + k] += deviation * table[(bits >> (16 * k)) & (kTableSize - 1)];
    }
  }
}

}  // namespace

devices::Image8 expose(const SimulatedCameraSpec& camera, const devices::ImageF& radiance, double exposure,
                       std::uint64_t noiseSeed) {
  devices::Image8 photo(radiance.size(), 3);
  const auto scale = static_cast<float>(exposure);
  const auto curve = makeCurve(camera.gamma);
  const bool linear = camera.gamma == 1.0;
  const Noise noise{static_cast<float>(1 / camera.fullWell),
                    static_cast<float>(camera.readNoise * camera.readNoise / (camera.fullWell * camera.fullWell))};
  inTwoHalves(photo.height(), [&](int first, int last) {
    std::vector<float> line(radiance.row(0).size());
    for (int y = first; y < last; ++y) {
      std::ranges::transform(radiance.row(y), line.begin(),
                             [scale](float light) { return std::min(1.0F, light * scale); });
      addNoise(line, noise, Random(noiseSeed ^ (0x51ed2701ULL * static_cast<std::uint64_t>(y + 1))));
      const auto quantise = [&](float part) {
        const float level = std::clamp(part, 0.0F, 1.0F);
        if (linear) return static_cast<std::uint8_t>(level * 255 + 0.5F);
        return curve[static_cast<std::size_t>(level * static_cast<float>(kCurveSteps) + 0.5F)];
      };
      std::ranges::transform(line, photo.row(y).begin(), quantise);
    }
  });
  return photo;
}

}  // namespace pixelflex::calib
