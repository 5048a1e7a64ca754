#include "tests/support_calibration/response_error.h"

#include <algorithm>
#include <cmath>

namespace pixelflex::calib {

double responseError(const ResponseCurve& curve, const SimulatedWall& room, std::size_t projector) {
  constexpr double kFloor = 0.01;  // of white: below it the error is relative to this
  double squares = 0;
  for (int c = 0; c < 3; ++c) {
    const double black = room.light(projector, c, 0);
    const double white = room.light(projector, c, 1) - black;
    for (std::size_t code = 20; code <= 235; ++code) {
      const double truth = (room.light(projector, c, static_cast<double>(code) / 255) - black) / white;
      const double found = curve.light.at(static_cast<std::size_t>(c)).at(code);
      squares += std::pow((found - truth) / std::max(truth, kFloor), 2);
    }
  }
  return std::sqrt(squares / (3 * 216));
}

}  // namespace pixelflex::calib
