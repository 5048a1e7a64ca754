#pragma once

#include <memory>
#include <string>

#include "devices/image/size.h"
#include "viewer/vnc/security.h"
#include "viewer/vnc/session.h"
#include "viewer/vnc/tls_session.h"
#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {

/// What was agreed on.
struct Handshake {
  std::unique_ptr<TlsSession> tls;  // what follows goes through this; null: in the clear
  ConnectionSecurity security;
  devices::Size desktop;    // as announced, not checked
  std::string desktopName;  // in the server's own encoding
};

/// The protocol's beginning on a connected socket, from the server's first byte to its ServerInit; reads not a byte
/// more. Takes the best security that the server offers and the options allow, and no other if that fails. Throws
/// SessionError whatever the server does, and SessionStopped.
[[nodiscard]] Handshake shakeHands(int socket, const SessionOptions& options, Deadline deadline, const Signal& stop);

}  // namespace pixelflex::viewer
