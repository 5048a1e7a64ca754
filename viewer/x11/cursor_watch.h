#pragma once

#include <optional>
#include <vector>

#include "viewer/vnc/session_event.h"
#include "viewer/x11/x_connection.h"

namespace pixelflex::viewer {

/// The pointer of an X server: its picture, and where others than we put it. The session's thread.
class CursorWatch {
 public:
  /// `connection` must outlive this and have been asked for XFixes before.
  explicit CursorWatch(const XConnection& connection);

  void handle(const XEvent& event);
  /// We have put the pointer there: no news.
  void expectAt(int x, int y) { at_ = {x, y}; }
  /// Programs may put the pointer somewhere without any event: asks at the next takeEvents().
  void look() { moved_ = true; }
  /// What has changed since the last call; asks the server only when something may have.
  [[nodiscard]] std::vector<SessionEvent> takeEvents();

 private:
  void watchMotion();
  [[nodiscard]] CursorShape shape() const;
  [[nodiscard]] std::optional<CursorMoved> position() const;

  const XConnection& connection_;
  int cursorEvent_ = 0;
  int inputOpcode_ = -1;  // -1: motion is not told
  bool shapeChanged_ = true;
  bool moved_ = true;
  CursorMoved at_{-1, -1};
};

}  // namespace pixelflex::viewer
