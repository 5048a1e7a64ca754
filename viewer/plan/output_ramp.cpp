#include "viewer/plan/output_ramp.h"

#include <algorithm>
#include <cmath>

namespace pixelflex::viewer {
namespace {

double lightOf(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

/// Entries are evenly spaced in light^(1/2.2).
double codeFor(double light, const std::vector<float>& entries) {
  const double place = std::pow(light, 1 / 2.2) * static_cast<double>(entries.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(place), entries.size() - 2);
  return std::lerp(double{entries[low]}, double{entries[low + 1]}, place - static_cast<double>(low));
}

}  // namespace

devices::GammaRamp rampOf(const std::array<std::vector<float>, 3>& inverseResponse, std::size_t entries) {
  devices::GammaRamp ramp;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < entries; ++i) {
      const double shown = static_cast<double>(i) / static_cast<double>(entries - 1);
      const double code =
          inverseResponse[c].empty() ? shown : std::clamp(codeFor(lightOf(shown), inverseResponse[c]), 0.0, 1.0);
      ramp[c].push_back(static_cast<std::uint16_t>(std::lround(65535 * code)));
    }
  }
  return ramp;
}

}  // namespace pixelflex::viewer
