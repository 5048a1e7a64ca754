#pragma once

#include <cstddef>

#include "calib/photometric/response_curve.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {

/// How far a curve is from what a simulated projector does: relative to light (of 1 % of white at least), RMS over
/// codes 20 to 235 and the channels.
[[nodiscard]] double responseError(const ResponseCurve& curve, const SimulatedWall& room, std::size_t projector);

}  // namespace pixelflex::calib
