#pragma once

#include <functional>
#include <memory>
#include <string>

#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {

/// Until something listens there. Throws std::runtime_error after a generous time.
void waitForPort(int port);

/// A program of others between a TCP port and a serial device.
class Bridge {
 public:
  enum class Kind { kSer2netRaw, kSer2netRfc2217, kSocat };
  Bridge(Kind kind, const std::string& serialDevice);
  [[nodiscard]] std::string address() const;

 private:
  Kind kind_;
  int port_;
  TemporaryFolder folder_;
  std::unique_ptr<Process> process_;
};

}  // namespace pixelflex::testing
