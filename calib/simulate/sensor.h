#pragma once

#include <cstdint>

#include "calib/simulate/rig.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// From light to codes: electrons with shot and read noise, clipped at full scale, the camera's curve, eight bits.
/// `radiance` has three channels; `exposure` times radiance is the part of full scale. The same `noiseSeed` gives the
/// same photograph. Uses both cores.
[[nodiscard]] devices::Image8 expose(const SimulatedCameraSpec& camera, const devices::ImageF& radiance,
                                     double exposure, std::uint64_t noiseSeed);

}  // namespace pixelflex::calib
