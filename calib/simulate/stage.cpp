#include "calib/simulate/stage.h"

#include <algorithm>
#include <utility>

#include "calib/simulate/cylindrical_screen.h"
#include "calib/simulate/planar_screen.h"

namespace pixelflex::calib {

std::unique_ptr<const Screen> makeScreen(const Rig& rig) {
  if (rig.screenRadius == 0) return std::make_unique<PlanarScreen>();
  return std::make_unique<CylindricalScreen>(rig.screenRadius, rig.screenTopLeft.x + 0.5 * rig.screenSize.x);
}

double largestGain(const Response& response) {
  return *std::ranges::max_element(response.gain);
}

Stage::Stage(Rig rig, const Rig& reference) : rig_(std::move(rig)), screen_(makeScreen(rig_)) {
  for (const auto& spec : rig_.projectors) lights_.emplace_back(spec, *screen_);
  measureLight(reference);
}

void Stage::measureLight(const Rig& reference) {
  double brightest = 0;
  double brightestChannel = 0;
  double sum = 0;
  for (const auto& spec : reference.projectors) {
    const auto level = ProjectorLight(spec, *screen_).level();
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
