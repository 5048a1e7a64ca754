#pragma once

#include <stdexcept>

namespace pixelflex::devices {

/// A camera cannot be had or has failed; what() names it as wall.yaml does, says what is wrong and what to do.
class CameraError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace pixelflex::devices
