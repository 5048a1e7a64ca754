#pragma once

#include <string>

#include "viewer/vnc/rfb_state.h"

namespace pixelflex::viewer {

/// Reads a ServerCutText, plain or extended, after its type. Texts beyond SessionOptions::clipboardLimit are read over
/// and left out, which an event tells. Answers what the server asks. Throws SessionError.
void readClipboard(RfbState& rfb);

/// Text was copied here, UTF-8: a server with the Extended Clipboard is told and fetches it when somebody pastes, any
/// other gets it at once as Latin-1. Texts beyond the limit are not sent, nor told of.
void offerClipboard(RfbState& rfb, const std::string& text);

}  // namespace pixelflex::viewer
