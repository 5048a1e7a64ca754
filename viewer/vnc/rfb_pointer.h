#pragma once

#include "viewer/vnc/rfb_state.h"

namespace pixelflex::viewer {

/// Read a pointer's shape in one of the three ways that servers send it, into the state's events. Throw SessionError,
/// also for shapes larger than 1024 pixels each way. An empty one hides the pointer.
void readRichCursor(RfbState& rfb, devices::Size size, int hotX, int hotY);
void readXCursor(RfbState& rfb, devices::Size size, int hotX, int hotY);
void readAlphaCursor(RfbState& rfb, devices::Size size, int hotX, int hotY);

}  // namespace pixelflex::viewer
