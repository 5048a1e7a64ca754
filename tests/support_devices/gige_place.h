#pragma once

#include <unistd.h>

#include <string>

namespace pixelflex::testing {

/// An address and a serial number that no other test of this machine has for its GigE Vision camera.
struct GigePlace {
  explicit GigePlace(int number = 0) {
    const int process = static_cast<int>(::getpid());
    address = "127." + std::to_string(64 + number) + "." + std::to_string(process / 250 % 250) + "." +
              std::to_string(1 + process % 250);
    serial = "T" + std::to_string(process) + "-" + std::to_string(number);
  }
  std::string address;
  std::string serial;
};

}  // namespace pixelflex::testing
