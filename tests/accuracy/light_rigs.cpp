#include "tests/accuracy/light_rigs.h"

#include <utility>

#include "calib/simulate/random.h"
#include "calib/simulate/rig_generator.h"

namespace pixelflex::calib {
namespace {

Rig unlikePair(std::uint32_t seed) {
  return withUnlikeLight(casualRig(2, 1, {1024, 768}, seed), seed);
}

}  // namespace

const std::vector<LightRig>& lightRigs() {
  static const std::vector<LightRig> kRigs = {
      {.name = "pair", .make = unlikePair, .response = true},
      {.name = "report-8", .make = [](auto seed) { return withUnlikeLight(reportRig(seed), seed); }, .text = true},
      {.name = "inset", .make = [](auto seed) { return withUnlikeLight(insetRig(seed), seed); }, .inset = true},
      {.name = "stacked", .make = [](auto seed) { return withUnlikeLight(stackedRig(seed), seed); }},
  };
  return kRigs;
}

Rig withUnlikeLight(Rig rig, std::uint32_t seed) {
  Random random((std::uint64_t{seed} << 32U) + rig.projectors.size());
  for (auto& projector : rig.projectors) {
    projector.lumens = 1500 * random.between(0.85, 1.15);
    projector.vignetting = random.between(0.2, 0.4);
    Response& response = projector.response;
    const double gamma = random.between(1.95, 2.45);
    for (double& channel : response.gamma) channel = gamma + random.between(-0.05, 0.05);
    for (double& channel : response.gain) channel = random.between(0.92, 1.08);
    response.toe = random.between(0.002, 0.015);
    response.black = random.between(0.001, 0.004);
  }
  return rig;
}

Rig focused(Rig rig) {
  constexpr double kSharp = 0.3;  // projector pixels: what optics and the gaps between pixels leave
  for (auto& projector : rig.projectors) projector.defocus = kSharp;
  return rig;
}

Rig slipped(Rig rig, double pixels) {
  for (std::size_t i = 1; i < rig.projectors.size(); i += 2) rig.projectors[i].optics.principal.x += pixels;
  return rig;
}

}  // namespace pixelflex::calib
