#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/certificates.h"
#include "tests/support/fake_vnc_server.h"

namespace pixelflex::testing {

/// The server's end of TLS on a connection of FakeVncServer: without certificates, or with one.
class TlsServer {
 public:
  /// The handshake is done when this returns. Null: anonymous. Throws FakeConnection::ClientGone when it fails.
  TlsServer(const FakeConnection& connection, const Certificates* certificates);
  ~TlsServer();
  TlsServer(const TlsServer&) = delete;
  TlsServer& operator=(const TlsServer&) = delete;

  void send(const Message& message) const;
  [[nodiscard]] std::vector<std::uint8_t> receive(std::size_t count) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pixelflex::testing
