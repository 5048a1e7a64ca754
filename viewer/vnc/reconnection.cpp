#include "viewer/vnc/reconnection.h"

#include <utility>

#include "viewer/vnc/backoff.h"
#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {

Reconnection::Reconnection(Retry retry, std::string server, SessionDesk& desk)
    : retry_(retry), server_(std::move(server)), desk_(desk) {}

void Reconnection::run(const std::stop_token& stop, const std::function<void()>& talk) {
  Backoff backoff;
  try {
    while (true) {
      const auto begun = Clock::now();
      Closed end = converse(talk);
      desk_.close();
      if (stop.stop_requested()) return;
      if (!triesAgain(end.kind)) return desk_.post({std::move(end)});
      const CloseKind kind = end.kind;
      if (!std::exchange(lost_, true)) desk_.post({Lost{kind, std::move(end.message)}});
      // An attempt in vain may have been a wait itself.
      const auto since = connectedSince_ ? Clock::now() : begun;
      waitFor(-1, 0, since + backoff.after(kind, lasted()), desk_.stopped());
    }
  } catch (const SessionStopped&) {
    desk_.close();
  }
}

void Reconnection::connected() {
  connectedSince_ = Clock::now();
  everConnected_ = true;
  lost_ = false;
}

// One connection from its first byte to its end: why it ended.
Closed Reconnection::converse(const std::function<void()>& talk) {
  connectedSince_.reset();
  try {
    talk();
  } catch (const SessionError& error) {
    return {error.kind(), error.what()};
  } catch (const std::exception& error) {
    return {CloseKind::kLost, server_ + " ended: " + error.what()};
  }
  return {CloseKind::kLost, server_ + " ended"};
}

bool Reconnection::triesAgain(CloseKind kind) const {
  const bool wanted = retry_ == Retry::kAlways || (retry_ == Retry::kLost && everConnected_);
  return wanted && mayHeal(kind);
}

Reconnection::Clock::duration Reconnection::lasted() const {
  return connectedSince_ ? Clock::now() - *connectedSince_ : Clock::duration::zero();
}

}  // namespace pixelflex::viewer
