#pragma once

#include "viewer/vnc/rfb_state.h"

namespace pixelflex::viewer {

/// Reads a FramebufferUpdate, whose type byte was read already, into the state's pixels, damage and events; asks for
/// the next one first, unless the server sends them unasked. Each rectangle is checked here: its encoding is one that
/// was asked for, it lies on the desktop. Only Tight (but not its JPEG pictures, of which the workers decode the large
/// ones) and ZRLE rectangles are left to libvncclient, one at a time. Throws SessionError.
void readUpdate(RfbState& rfb);

}  // namespace pixelflex::viewer
