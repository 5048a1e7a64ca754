#pragma once

#include "viewer/vnc/rfb_state.h"

namespace pixelflex::viewer {

/// Sends what the layout that is wanted, if any, needs: once the server has said that it can change its own.
void requestWantedLayout(RfbState& rfb);

/// Reads an ExtendedDesktopSize rectangle after its head, whose position holds who asked for it and what became of
/// that. True when the desktop has the rectangle's size. Throws SessionError.
[[nodiscard]] bool readExtendedDesktopSize(RfbState& rfb, int reason, int status, devices::Size size);

/// After a whole update: a server that says nothing of its screens by then cannot change them.
void noteUpdateForResize(RfbState& rfb);

}  // namespace pixelflex::viewer
