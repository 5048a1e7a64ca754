#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "viewer/remote/pjlink_session.h"
#include "viewer/remote/tcp_listener.h"

namespace pixelflex::viewer {

struct PjlinkServerOptions {
  ListenAddress at;
  std::string password;                          // empty: nobody is asked for one
  std::size_t connections = 32;                  // at once; more are closed at once
  std::chrono::milliseconds idle{30'000};        // a connection is closed so long after its last answer
  std::chrono::milliseconds refusalDelay{1000};  // before a wrong password is told, so that guessing takes long
};

/// PJLink over TCP on a loop's thread.
class PjlinkServer {
 public:
  /// `loop` must outlive it. `obey` is called on the loop's thread, so it must not wait for anything. Throws
  /// std::runtime_error when nothing can listen there.
  PjlinkServer(devices::LineLoop& loop, const PjlinkServerOptions& options, PjlinkSession::Obey obey);
  /// Not on the loop's thread. No call of `obey` goes on after it.
  ~PjlinkServer();
  PjlinkServer(const PjlinkServer&) = delete;
  PjlinkServer& operator=(const PjlinkServer&) = delete;

  /// With the port that a 0 became.
  [[nodiscard]] const ListenAddress& address() const { return listener_.address(); }

 private:
  struct Core;
  devices::LineLoop& loop_;
  std::shared_ptr<Core> core_;
  TcpListener listener_;
};

}  // namespace pixelflex::viewer
