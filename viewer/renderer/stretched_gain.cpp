#include "viewer/renderer/stretched_gain.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pixelflex::viewer {
namespace {

constexpr float kOne = 65535;

/// Between which two samples a pixel's centre lies, and how near the second.
struct Place {
  int first = 0;
  int second = 0;
  float t = 0;
};

std::vector<Place> placesOf(int pixels, int samples) {
  std::vector<Place> places;
  for (int i = 0; i < pixels; ++i) {
    const double at = std::clamp((i + 0.5) * samples / pixels - 0.5, 0.0, samples - 1.0);
    const int first = static_cast<int>(std::floor(at));
    places.push_back({first, std::min(first + 1, samples - 1), static_cast<float>(at - first)});
  }
  return places;
}

float mixed(std::uint16_t a, std::uint16_t b, float t) {
  return static_cast<float>(a) + t * (static_cast<float>(b) - static_cast<float>(a));
}

}  // namespace

devices::ImageF stretchedGain(const devices::Image16& gain, const devices::Image16& mask, devices::Size frame) {
  assert(gain.channels() == 1 && (mask.empty() || (mask.size() == frame && mask.channels() == 1)));
  const auto across = placesOf(frame.width, gain.width());
  const auto down = placesOf(frame.height, gain.height());
  devices::ImageF product(frame, 1);
  for (int y = 0; y < frame.height; ++y) {
    const auto& row = down[static_cast<std::size_t>(y)];
    // Plain pointers: this is done for every pixel of the wall before its first picture.
    const std::uint16_t* const above = gain.row(row.first).data();
    const std::uint16_t* const below = gain.row(row.second).data();
    const std::uint16_t* const weights = mask.empty() ? nullptr : mask.row(y).data();
    float* to = product.row(y).data();
    for (std::size_t x = 0; x < across.size(); ++x) {
      const auto& [first, second, t] = across[x];
      const float upper = mixed(above[first], above[second], t);
      const float lower = mixed(below[first], below[second], t);
      const float weight = weights == nullptr ? 1.0F : static_cast<float>(weights[x]) / kOne;
      *to++ = (upper + row.t * (lower - upper)) / kOne * weight;
    }
  }
  return product;
}

}  // namespace pixelflex::viewer
