#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "viewer/vnc/session.h"
#include "viewer/vnc/session_desk.h"

namespace pixelflex::viewer {

/// The life of a session's thread: one connection after the other, as its owner's wishes and Backoff say. On the
/// session's thread alone.
class Reconnection {
 public:
  /// `server` is how messages about an unexpected end begin, such as "the session with HOST". The desk must outlive
  /// this.
  Reconnection(Retry retry, std::string server, SessionDesk& desk);

  /// Runs `talk` for each connection, from its first byte on; it ends by what it throws. Returns when stopped, or when
  /// the session is over, which the desk is told then.
  void run(const std::stop_token& stop, const std::function<void()>& talk);
  /// To be called by `talk` once the desktop is there.
  void connected();
  /// Whether a connection was lost and is not back yet.
  [[nodiscard]] bool lost() const { return lost_; }

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] Closed converse(const std::function<void()>& talk);
  [[nodiscard]] bool triesAgain(CloseKind kind) const;
  [[nodiscard]] Clock::duration lasted() const;

  Retry retry_;
  std::string server_;
  SessionDesk& desk_;
  bool lost_ = false;
  bool everConnected_ = false;
  std::optional<Clock::time_point> connectedSince_;
};

}  // namespace pixelflex::viewer
