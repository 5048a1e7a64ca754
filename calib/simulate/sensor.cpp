#include "calib/simulate/sensor.h"

#include <algorithm>
#include <cmath>
#include <numbers>
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
      const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
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

/// Four draws from each random number.
void drawNormals(std::vector<float>& normals, Random random) {
  const float* table = normalTable().data();
  for (std::size_t i = 0; i < normals.size(); i += 4) {
    const std::uint64_t bits = random.next();
    const std::size_t count = std::min<std::size_t>(4, normals.size() - i);
    for (std::size_t k = 0; k < count; ++k) normals[i + k] = table[(bits >> (16 * k)) & (kTableSize - 1)];
  }
}

/// Light to parts of full scale, with noise, clipped to 0..1. Plain arithmetic that the compiler can do eight at a
/// time.
void addNoise(const float* light, float scale, Noise noise, const std::vector<float>& normals,
              std::vector<float>& line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const float signal = std::min(1.0F, std::max(0.0F, light[i] * scale));
    const float level = signal + std::sqrt(signal * noise.perElectron + noise.read) * normals[i];
    line[i] = std::min(1.0F, std::max(0.0F, level));
  }
}

/// 0..1 to codes; `curve` is empty for a linear camera.
void quantise(const std::vector<float>& line, const std::vector<std::uint8_t>& curve, std::uint8_t* out) {
  if (curve.empty()) {
    for (std::size_t i = 0; i < line.size(); ++i) out[i] = static_cast<std::uint8_t>(line[i] * 255 + 0.5F);
    return;
  }
  for (std::size_t i = 0; i < line.size(); ++i) {
    out[i] = curve[static_cast<std::size_t>(line[i] * static_cast<float>(kCurveSteps) + 0.5F)];
  }
}

}  // namespace

devices::Image8 expose(const SimulatedCameraSpec& camera, const devices::ImageF& radiance, double exposure,
                       std::uint64_t noiseSeed) {
  devices::Image8 photo(radiance.size(), 3);
  const auto curve = camera.gamma == 1.0 ? std::vector<std::uint8_t>() : makeCurve(camera.gamma);
  const Noise noise{static_cast<float>(1 / camera.fullWell),
                    static_cast<float>(camera.readNoise * camera.readNoise / (camera.fullWell * camera.fullWell))};
  inTwoHalves(photo.height(), [&](int first, int last) {
    std::vector<float> normals(radiance.row(0).size());
    std::vector<float> line(normals.size());
    for (int y = first; y < last; ++y) {
      drawNormals(normals, Random(noiseSeed ^ (0x51ed2701ULL * static_cast<std::uint64_t>(y + 1))));
      addNoise(radiance.row(y).data(), static_cast<float>(exposure), noise, normals, line);
      quantise(line, curve, photo.row(y).data());
    }
  });
  return photo;
}

}  // namespace pixelflex::calib
