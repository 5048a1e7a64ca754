#pragma once

#include <chrono>

#include "viewer/vnc/session_event.h"

namespace pixelflex::viewer {

/// Whether a server that was left for this reason may be fit to talk to later, without anybody changing the command
/// line: a refused password is not asked to be refused again, many servers then lock the user out.
[[nodiscard]] bool mayHeal(CloseKind kind);

/// How long to wait before a server is tried again: a tenth of a second at first and never more than half a second, so
/// that the desktop is back within a second of the server. Only one that answers with nonsense is left alone for
/// longer.
class Backoff {
 public:
  /// Call it once for each connection that failed or ended. `lasted`: how long its desktop was there, zero if it never
  /// came so far.
  [[nodiscard]] std::chrono::milliseconds after(CloseKind kind, std::chrono::steady_clock::duration lasted);

 private:
  int failures_ = 0;  // in a row
};

}  // namespace pixelflex::viewer
