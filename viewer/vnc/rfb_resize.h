#pragma once

#include "viewer/vnc/rfb_state.h"

namespace pixelflex::viewer {

/// Sends what the layout that is wanted, if any, needs: once the server has told of its screens. One that has not by
/// the end of its first whole update cannot change them, and that is said instead.
void requestWantedLayout(RfbState& rfb);

/// Reads an ExtendedDesktopSize rectangle after its head, whose position holds who asked for it and what became of
/// that. True when the desktop has the rectangle's size. Throws SessionError.
[[nodiscard]] bool readExtendedDesktopSize(RfbState& rfb, int reason, int status, devices::Size size);

}  // namespace pixelflex::viewer
