#include "calib/simulate/random.h"

#include <cmath>
#include <numbers>

namespace pixelflex::calib {

double Random::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - between(0, 1)));
  return radius * std::cos(between(0, 2.0 * std::numbers::pi));
}

}  // namespace pixelflex::calib
