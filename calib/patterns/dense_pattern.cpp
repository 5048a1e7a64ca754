#include "calib/patterns/dense_pattern.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>

namespace pixelflex::calib {
namespace {

constexpr double kNominalGamma = 2.2;
constexpr double kFloor = 0.06;  // of the light; its code lies above the toe of any response
constexpr double kCrest = 0.9;   // nothing saturates
constexpr int kLatticePoints = 48;

/// Short periods measure finer, long ones survive a coarse camera: at most 80 across, so that a camera that spends a
/// few hundred pixels on the frame still resolves them.
int periodFor(devices::Size resolution) {
  constexpr int kShortest = 16;
  constexpr int kMostPeriods = 80;
  int period = kShortest;
  while (std::max(resolution.width, resolution.height) > kMostPeriods * period) period *= 2;
  return period;
}

int pointsAlong(int length, devices::Size resolution) {
  const double longest = std::max(resolution.width, resolution.height);
  return std::max(4, static_cast<int>(std::lround(kLatticePoints * length / longest)));
}

/// A picture in which a pixel's code depends on one coordinate only.
template <class Code>
devices::Image8 stripes(devices::Size resolution, bool alongX, const Code& code) {
  devices::Image8 image(resolution, 1);
  std::vector<std::uint8_t> codes;
  for (int i = 0; i < (alongX ? resolution.width : resolution.height); ++i) codes.push_back(code(i));
  for (int y = 0; y < resolution.height; ++y) {
    if (alongX) std::ranges::copy(codes, image.row(y).begin());
    if (!alongX) std::ranges::fill(image.row(y), codes[static_cast<std::size_t>(y)]);
  }
  return image;
}

ProjectedPattern uniform(devices::Size resolution, const std::string& name, std::uint8_t code) {
  return {"dense-" + name, "all " + name, [=] {
            devices::Image8 image(resolution, 1);
            std::ranges::fill(image.samples(), code);
            return image;
          }};
}

void addCode(std::vector<ProjectedPattern>& patterns, devices::Size resolution, const DenseAxis& axis, bool alongX) {
  for (int bit = 0; bit < axis.bits(); ++bit) {
    patterns.push_back({(alongX ? "dense-column" : "dense-row") + std::to_string(bit),
                        alongX ? "black and white columns" : "black and white rows", [=] {
                          return stripes(resolution, alongX, [&](int pixel) { return axis.grayCode(pixel, bit); });
                        }});
  }
}

void addWave(std::vector<ProjectedPattern>& patterns, devices::Size resolution, const DenseAxis& axis, bool alongX) {
  for (int step = 0; step < kPhaseSteps; ++step) {
    patterns.push_back({(alongX ? "dense-xphase" : "dense-yphase") + std::to_string(step),
                        alongX ? "soft narrow columns" : "soft narrow rows", [=] {
                          return stripes(resolution, alongX, [&](int pixel) { return axis.waveCode(pixel, step); });
                        }});
  }
}

}  // namespace

DenseAxis::DenseAxis(int length, int period) : length_(length), period_(period) {
  assert(length > 0 && period > 0 && period % 2 == 0);
  const int lastCell = (length - 1) / (period / 2);
  bits_ = static_cast<int>(std::bit_width(static_cast<unsigned>(lastCell)));
}

std::uint8_t DenseAxis::grayCode(int pixel, int bit) const {
  const int cell = pixel / (period_ / 2);
  const int gray = cell ^ (cell >> 1);
  return ((gray >> (bits_ - 1 - bit)) & 1) != 0 ? 255 : 0;
}

std::uint8_t DenseAxis::waveCode(int pixel, int step) const {
  const double turns = (pixel + 0.5) / period_ - static_cast<double>(step) / kPhaseSteps;
  const double wave = 0.5 + 0.5 * std::cos(2 * std::numbers::pi * turns);
  const double light = kFloor + (kCrest - kFloor) * wave;
  return static_cast<std::uint8_t>(std::lround(255 * std::pow(light, 1 / kNominalGamma)));
}

DenseLayout::DenseLayout(devices::Size resolution)
    : x_(resolution.width, periodFor(resolution)),
      y_(resolution.height, periodFor(resolution)),
      columns_(pointsAlong(resolution.width, resolution)),
      rows_(pointsAlong(resolution.height, resolution)),
      step_(resolution.width / (columns_ - 0.5), resolution.height / (rows_ - 0.5)),
      margin_(0.25 * step_) {}

std::vector<ProjectedPattern> densePatterns(devices::Size resolution) {
  const DenseLayout layout(resolution);
  std::vector<ProjectedPattern> patterns{uniform(resolution, "black", 0), uniform(resolution, "white", 255)};
  addCode(patterns, resolution, layout.x(), true);
  addCode(patterns, resolution, layout.y(), false);
  addWave(patterns, resolution, layout.x(), true);
  addWave(patterns, resolution, layout.y(), false);
  return patterns;
}

DenseOrder::DenseOrder(const DenseLayout& layout)
    : rowCode(columnCode + static_cast<std::size_t>(layout.x().bits())),
      xWave(rowCode + static_cast<std::size_t>(layout.y().bits())),
      yWave(xWave + kPhaseSteps),
      count(yWave + kPhaseSteps) {}

}  // namespace pixelflex::calib
