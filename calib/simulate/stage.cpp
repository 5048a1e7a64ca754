#include "calib/simulate/stage.h"

#include <algorithm>
#include <utility>

namespace pixelflex::calib {

double largestGain(const Response& response) {
  return *std::ranges::max_element(response.gain);
}

Stage::Stage(Rig rig) : rig_(std::move(rig)) {
  double brightest = 0;
  double brightestChannel = 0;
  double sum = 0;
  for (const auto& spec : rig_.projectors) {
    const auto level = lights_.emplace_back(spec, screen_).level();
    brightest = std::max(brightest, level.maximum);
    brightestChannel = std::max(brightestChannel, level.maximum * largestGain(spec.response));
    sum += level.mean;
  }
  if (brightest <= 0) return;  // nothing reaches the screen: only ambient light is left, in any unit
  unit_ = brightest;
  typicalWhite_ = sum / static_cast<double>(lights_.size()) / unit_;
  brightestWhite_ = brightestChannel / unit_;
}

}  // namespace pixelflex::calib
