#pragma once

#include <optional>

#include "viewer/vnc/server_address.h"
#include "viewer/x11/x_display.h"

namespace pixelflex::viewer {

/// The X display of this machine that a VNC server shows, when that is certain: the one process that listens there is
/// an X server itself (Xvnc), and it lets us in. Nothing for any other, such as x11vnc, which may show a part or change
/// its display, and for processes of other users, whose sockets cannot be seen.
[[nodiscard]] std::optional<XDisplay> displayBehind(const ServerAddress& server);

}  // namespace pixelflex::viewer
