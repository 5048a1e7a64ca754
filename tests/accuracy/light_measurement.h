#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "tests/accuracy/light_figures.h"
#include "tests/accuracy/light_rigs.h"

namespace pixelflex::calib {

/// Gets every figure as it is measured. `where`: the rig's kind, its seed, and the place on the desktop if it is one.
using Findings = std::function<void(Figure figure, Correction correction, double value, const std::string& where)>;

/// Calibrates a rig in a folder of its own and measures its light: ours with even black at uniformity 1 and 0.5, steps
/// at both; then without correction and by the report's method, if `others`. Throws what calibration and renderer
/// throw.
void measureLight(const LightRig& kind, std::uint32_t seed, bool others, const Findings& findings);

}  // namespace pixelflex::calib
