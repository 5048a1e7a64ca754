#pragma once

#include <vector>

#include "viewer/vnc/session_event.h"

namespace pixelflex::viewer {

/// Adds an event to those that wait for somebody to take them. A server may send pointer shapes, texts and bells
/// without end while nobody does: beyond a few, each drops the oldest of its kind. What tells of a connection is never
/// dropped.
void appendEvent(std::vector<SessionEvent>& events, SessionEvent event);

}  // namespace pixelflex::viewer
