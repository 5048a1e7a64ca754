#pragma once

#include <string>
#include <string_view>

namespace pixelflex::testing {

/// A UDP socket of 127.0.0.1 at a free port. Written with plain sockets.
class UdpTalk {
 public:
  UdpTalk();
  ~UdpTalk();
  UdpTalk(const UdpTalk&) = delete;
  UdpTalk& operator=(const UdpTalk&) = delete;

  [[nodiscard]] int port() const { return port_; }
  void send(int port, std::string_view bytes) const;
  /// The next datagram. Throws std::runtime_error when none comes within a generous time.
  [[nodiscard]] std::string receive() const;

 private:
  int socket_ = -1;
  int port_ = 0;
};

}  // namespace pixelflex::testing
