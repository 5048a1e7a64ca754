#pragma once

#include <chrono>
#include <string>

#include "viewer/vnc/server_address.h"
#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {

/// How messages call a server: "wall.example port 5901", "the socket /run/wall.sock".
[[nodiscard]] std::string describeServer(const ServerAddress& server);

struct ConnectLimits {
  std::chrono::milliseconds lookUp{10'000};   // of the host's name
  std::chrono::milliseconds connect{10'000};  // all of its addresses together
};

/// A connected, blocking stream socket; a TCP connection whose other end is gone breaks by itself within ten seconds.
/// Looks the name up and tries each of its addresses. Throws SessionError (kUnreachable) or, as soon as `stop` is
/// raised, SessionStopped; neither a name server nor a host that does not answer can hold it longer.
[[nodiscard]] FileDescriptor connectToServer(const ServerAddress& server, const ConnectLimits& limits,
                                             const Signal& stop);

}  // namespace pixelflex::viewer
