#pragma once

#include <atomic>
#include <thread>

#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {

/// libvncclient reads the handshake with blocking calls. While a watch exists, it shuts the socket down when the
/// deadline has passed, which ends such a call.
class HandshakeWatch {
 public:
  HandshakeWatch(int socket, Deadline deadline);
  ~HandshakeWatch();
  HandshakeWatch(const HandshakeWatch&) = delete;
  HandshakeWatch& operator=(const HandshakeWatch&) = delete;

  [[nodiscard]] bool expired() const { return expired_; }

 private:
  std::atomic<bool> expired_ = false;
  Signal done_;
  std::jthread thread_;
};

}  // namespace pixelflex::viewer
