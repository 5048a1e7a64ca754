#include "calib/patterns/response_pattern.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace pixelflex::calib {
namespace {

constexpr std::array<std::string_view, 3> kChannels = {"red", "green", "blue"};
constexpr std::string_view kPrefix = "response-";
constexpr int kSteps = 32;
constexpr int kChartColumns = 8;
constexpr int kChartRows = 6;
constexpr int kDarkestSquare = 24;  // the toe of a projector gives no light to speak of

std::string threeDigits(int code) {
  const std::string digits = std::to_string(code);
  return std::string(3 - digits.size(), '0') + digits;
}

/// Neighbours differ: dark and bright squares stand all over the frame.
std::uint8_t codeOfSquare(int column, int row) {
  constexpr int kCount = kChartColumns * kChartRows;
  constexpr int kStride = 29;  // no common factor with the count
  const int rank = (row * kChartColumns + column) * kStride % kCount;
  return static_cast<std::uint8_t>(kDarkestSquare + (255 - kDarkestSquare) * rank / (kCount - 1));
}

devices::Image8 drawChart(devices::Size resolution) {
  devices::Image8 image(resolution, 1);
  for (int y = 0; y < resolution.height; ++y) {
    for (int x = 0; x < resolution.width; ++x) {
      image.at(x, y) = codeOfSquare(x * kChartColumns / resolution.width, y * kChartRows / resolution.height);
    }
  }
  return image;
}

}  // namespace

std::vector<int> responseLevels() {
  std::vector<int> codes;
  for (int i = 1; i <= kSteps; ++i) codes.push_back(static_cast<int>(std::lround(255.0 * i / kSteps)));
  return codes;
}

ProjectedPattern levelPattern(devices::Size resolution, int channel, int code) {
  assert(channel >= 0 && channel < 3 && code > 0 && code < 256);
  const std::string colour(kChannels.at(static_cast<std::size_t>(channel)));
  return {colour + "-" + threeDigits(code), "all " + colour + ", level " + std::to_string(code), [=] {
            devices::Image8 image(resolution, 3);
            const auto samples = image.samples();
            for (std::size_t i = static_cast<std::size_t>(channel); i < samples.size(); i += 3) {
              samples[i] = static_cast<std::uint8_t>(code);
            }
            return image;
          }};
}

ProjectedPattern responseBlackPattern(devices::Size resolution) {
  return {std::string(kPrefix) + "black", "all black", [=] { return devices::Image8(resolution, 1); }};
}

ProjectedPattern responseChart(devices::Size resolution) {
  return {std::string(kPrefix) + "chart", "squares of many greys", [=] { return drawChart(resolution); }};
}

std::string ambientName() {
  return std::string(kPrefix) + "ambient";
}

std::vector<ProjectedPattern> responsePatterns(devices::Size resolution) {
  std::vector<ProjectedPattern> patterns = {responseChart(resolution), responseBlackPattern(resolution)};
  for (int channel = 0; channel < 3; ++channel) {
    for (const int code : responseLevels()) patterns.push_back(levelPattern(resolution, channel, code));
  }
  return patterns;
}

bool isOfResponse(const std::string& name) {
  if (name.starts_with(kPrefix)) return true;
  return std::ranges::any_of(kChannels,
                             [&](std::string_view colour) { return name.starts_with(std::string(colour) + "-"); });
}

}  // namespace pixelflex::calib
