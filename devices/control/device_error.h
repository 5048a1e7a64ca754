#pragma once

#include <stdexcept>

namespace pixelflex::devices {

/// A device that answers cannot or will not do what it was asked; the message names it and says what to do.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace pixelflex::devices
