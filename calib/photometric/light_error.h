#pragma once

#include <stdexcept>

namespace pixelflex::calib {

/// Measurements of light that projectors cannot be matched by; what() says which, why and what to do.
class LightError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace pixelflex::calib
