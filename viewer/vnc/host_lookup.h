#pragma once

#include <sys/socket.h>

#include <string>
#include <vector>

#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {

/// One address of a host, ready for connect().
struct HostAddress {
  sockaddr_storage storage{};
  socklen_t length = 0;
};

/// The addresses of a host, best first. The system's resolver cannot be interrupted, so names are looked up on a thread
/// that is left behind when the deadline passes or `stop` is raised. Throws SessionError (kUnreachable),
/// SessionStopped.
[[nodiscard]] std::vector<HostAddress> lookUpHost(const std::string& host, int port, Deadline deadline,
                                                  const Signal& stop);

}  // namespace pixelflex::viewer
