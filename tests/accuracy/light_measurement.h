#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "tests/accuracy/light_figures.h"
#include "tests/accuracy/light_rigs.h"

namespace pixelflex::calib {

/// Calibrates a rig in a folder of its own and adds every figure of its light: ours with even black at uniformity 1 and
/// 0.5, of steps the larger of the two; then without correction and by the report's method, if `others`. `tell` gets a
/// line for each figure. Throws what calibration and renderer throw.
void measureLight(const LightRig& kind, std::uint32_t seed, bool others, LightFigures& figures,
                  const std::function<void(const std::string&)>& tell);

}  // namespace pixelflex::calib
