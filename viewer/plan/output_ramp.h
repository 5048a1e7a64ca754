#pragma once

#include <cstddef>

#include "devices/display/gamma_keeper.h"
#include "viewer/plan/projector_light.h"

namespace pixelflex::viewer {

/// The look-up from sRGB codes of light to a projector's device codes, as an output's hardware does it.
/// `inverseResponse`: as in ProjectorLight, of at least two entries a channel, or empty: codes
/// stay as they are; `entries`: of each table, at least two.
[[nodiscard]] devices::GammaRamp rampOf(const std::array<std::vector<float>, 3>& inverseResponse, std::size_t entries);

}  // namespace pixelflex::viewer
