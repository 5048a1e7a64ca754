#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

namespace pixelflex::testing {

struct RelayLimits {
  double bytesPerSecond = 1e9;         // from the server to the client
  std::chrono::milliseconds delay{0};  // each way
};

/// A long way to a server: listens on a port of 127.0.0.1 and hands the first client's bytes to the server and back, no
/// faster than it is told.
class SlowRelay {
 public:
  /// `server` is a port of 127.0.0.1. Throws std::runtime_error.
  SlowRelay(int server, RelayLimits limits);
  ~SlowRelay();
  SlowRelay(const SlowRelay&) = delete;
  SlowRelay& operator=(const SlowRelay&) = delete;

  /// As users write it.
  [[nodiscard]] const std::string& address() const { return address_; }

 private:
  void serve(const std::stop_token& stop, int server, RelayLimits limits) const;

  int listener_ = -1;
  std::string address_;
  std::jthread thread_;
};

}  // namespace pixelflex::testing
