#pragma once

#include <string>
#include <string_view>

#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {

/// An X server of this machine.
struct XDisplay {
  int number = 0;
  int screen = 0;

  /// ":7", or ":7.1" for another screen than the first.
  [[nodiscard]] std::string text() const;
  bool operator==(const XDisplay&) const = default;
};

/// Reads ":7", ":7.1" or "7". Throws std::invalid_argument, whose message quotes the text and says how to write it.
[[nodiscard]] XDisplay parseXDisplay(std::string_view text);

/// What an X server may want to see of whoever connects, out of the user's .Xauthority file.
struct XCookie {
  std::string name;  // both empty: there is none for this server
  std::string data;
};

/// PIXELFLEX_XAUTHORITY names a file to look into first, for a viewer whose windows are on another display.
[[nodiscard]] XCookie cookieFor(const XDisplay& display);

/// Connects to the server's UNIX socket, non-blocking. Throws SessionError (kUnreachable).
[[nodiscard]] FileDescriptor connectToDisplay(const XDisplay& display);

/// Asks the server on a connection of its own (its first) to let us in. libxcb, which asks again, would wait for a
/// stalled server for ever and cannot tell why it was refused. Throws SessionError (kAuthentication with the server's
/// own words, or kLost) or, as soon as `stop` is raised, SessionStopped.
void requireWelcome(const XDisplay& display, int socket, const XCookie& cookie, Deadline deadline, const Signal& stop);

}  // namespace pixelflex::viewer
