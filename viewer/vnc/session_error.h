#pragma once

#include <stdexcept>
#include <string>

#include "viewer/vnc/session_event.h"

namespace pixelflex::viewer {

/// The session cannot go on; becomes its Closed event.
class SessionError : public std::runtime_error {
 public:
  SessionError(CloseKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  [[nodiscard]] CloseKind kind() const { return kind_; }

 private:
  CloseKind kind_;
};

/// Thrown out of a wait when the session was told to stop; nothing went wrong.
struct SessionStopped {};

}  // namespace pixelflex::viewer
