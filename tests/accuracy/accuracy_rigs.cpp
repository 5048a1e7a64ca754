#include "tests/accuracy/accuracy_rigs.h"

#include "calib/simulate/rig_generator.h"

namespace pixelflex::calib {
namespace {

/// The report's rig seen by a camera of 1280x720 pixels and twice the noise, relative to its full scale.
Rig coarseRig(std::uint32_t seed) {
  Rig rig = casualRig(4, 2, {1024, 768}, seed, {1280, 720});
  rig.camera.fullWell /= 4;
  rig.camera.readNoise /= 2;
  return rig;
}

Rig pairRig(std::uint32_t seed) {
  return casualRig(2, 1, {1024, 768}, seed);
}

}  // namespace

const std::vector<AccuracyRig>& accuracyRigs() {
  constexpr AccuracyTarget kUsual{0.03, 0.12, 0.2};
  constexpr AccuracyTarget kHard{0.04, 0.15, 0.2};
  static const std::vector<AccuracyRig> kRigs = {
      {"pair", pairRig, kUsual, {}},
      {"report-8", reportRig, kUsual, {}},
      {"stacked", stackedRig, kUsual, {}},
      {"portrait", portraitRig, kUsual, {}},
      {"short-throw", shortThrowRig, kHard, {}},
      {"inset", insetRig, kHard, 0},
      {"report-8-coarse", coarseRig, {0.08, 0.3, 0.4}, {}},
      {"cylinder", cylinderRig, {0.06, 0.25, 0.5}, {}, true},
      {"large-18", largeRig, {0.05, 0.2, 0.4}, {}},
  };
  return kRigs;
}

}  // namespace pixelflex::calib
