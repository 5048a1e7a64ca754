#pragma once

#include <chrono>
#include <string>

#include "viewer/vnc/server_address.h"
#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {

/// How messages call a server: "wall.example port 5901", "the socket /run/wall.sock".
[[nodiscard]] std::string describeServer(const ServerAddress& server);

/// A connected, blocking stream socket. Looks the name up, tries each of its addresses, all within `timeout`. Throws
/// SessionError (kUnreachable) or, as soon as `stop` is raised, SessionStopped; neither a name server nor a host that
/// does not answer can hold it longer.
[[nodiscard]] FileDescriptor connectToServer(const ServerAddress& server, std::chrono::milliseconds timeout,
                                             const Signal& stop);

}  // namespace pixelflex::viewer
