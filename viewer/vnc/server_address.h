#pragma once

#include <string>
#include <string_view>

namespace pixelflex::viewer {

/// The first display's TCP port; display N listens at kFirstPort + N.
inline constexpr int kFirstPort = 5900;

/// Where a desktop is served: a VNC server at a TCP port of a host or at a UNIX socket, or an X server of this machine.
struct ServerAddress {
  std::string host;        // a name or a numeric address, without brackets; empty for a UNIX socket
  int port = kFirstPort;   // 1..65535; meaningless for a UNIX socket
  std::string socketPath;  // empty for TCP
  std::string xDisplay;    // as in ":7": an X server, and nothing else counts; empty for a VNC server

  [[nodiscard]] bool isXDisplay() const { return !xDisplay.empty(); }
  [[nodiscard]] bool isUnixSocket() const { return !socketPath.empty(); }
  /// The address as a user would write it; parseServerAddress() gives the same value back.
  [[nodiscard]] std::string text() const;
  bool operator==(const ServerAddress&) const = default;
};

/// Reads `HOST:DISPLAY`, `HOST::PORT`, `[V6]:DISPLAY`, `[V6]::PORT`, `unix:PATH`, `x11:DISPLAY`, or a bare host
/// (display 0). Throws std::invalid_argument, whose message quotes the text and says how to write it.
[[nodiscard]] ServerAddress parseServerAddress(std::string_view text);

}  // namespace pixelflex::viewer
