#include "calib/estimate/response_samples.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace pixelflex::calib {
namespace {

constexpr double kDarkest = 2;
constexpr double kBrightest = 252;
constexpr std::size_t kPatchesOfATone = 40;
constexpr int kToneWidth = 4;  // codes

/// The mean of an even patch in range; none elsewhere. Means of uneven patches are bent by the curve.
std::optional<double> codeOf(const devices::Image8& photo, int left, int top, int side, int channel) {
  double sum = 0;
  double squares = 0;
  std::uint8_t least = 255;
  std::uint8_t most = 0;
  for (int y = top; y < top + side; ++y) {
    for (int x = left; x < left + side; ++x) {
      const std::uint8_t code = photo.at(x, y, channel);
      sum += code;
      squares += double{1} * code * code;
      least = std::min(least, code);
      most = std::max(most, code);
    }
  }
  const double count = double{1} * side * side;
  const double mean = sum / count;
  const double deviation = std::sqrt(std::max(0.0, squares / count - mean * mean));
  const bool inRange = mean > kDarkest && mean < kBrightest && least > 0 && most < 255;
  return inRange && deviation < 3 + 0.05 * mean ? std::optional(mean) : std::nullopt;
}

/// Patches of about this many pixels' side make some thousands of a picture.
int patchSide(devices::Size size) {
  return std::clamp(static_cast<int>(std::sqrt(static_cast<double>(size.area()) / 8000)), 4, 16);
}

/// Which tone a patch is: the photograph that holds it nearest to the middle, and its code there.
std::size_t toneOf(const std::vector<std::optional<double>>& codes) {
  std::size_t best = 0;
  double distance = 256;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (!codes[i] || std::abs(*codes[i] - 128) >= distance) continue;
    best = i;
    distance = std::abs(*codes[i] - 128);
  }
  return best * (256 / kToneWidth) + static_cast<std::size_t>(*codes[best]) / kToneWidth;
}

PatchCodes joined(const std::vector<std::optional<double>>& codes, std::span<const ExposedPhoto> photos) {
  PatchCodes patch;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (codes[i]) patch.push_back({std::log(photos[i].exposure), *codes[i]});
  }
  return patch;
}

}  // namespace

std::vector<PatchCodes> collectPatches(std::span<const ExposedPhoto> photos, int channel) {
  const devices::Size size = photos.front().photo.size();
  const int side = patchSide(size);
  const std::int64_t columns = size.width / side;
  const std::int64_t count = columns * (size.height / side);
  std::vector<PatchCodes> patches;
  std::vector<std::size_t> taken(photos.size() * (256 / kToneWidth), 0);
  constexpr std::int64_t kStride = 104729;  // a prime: visits every patch once, far from the one before
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t at = count % kStride == 0 ? i : i * kStride % count;
    std::vector<std::optional<double>> codes;
    for (const auto& one : photos) {
      codes.push_back(codeOf(one.photo, static_cast<int>(at % columns) * side, static_cast<int>(at / columns) * side,
                             side, channel));
    }
    const auto found = std::ranges::count_if(codes, [](const auto& code) { return code.has_value(); });
    if (found < 2 || taken[toneOf(codes)]++ >= kPatchesOfATone) continue;
    patches.push_back(joined(codes, photos));
  }
  return patches;
}

}  // namespace pixelflex::calib
