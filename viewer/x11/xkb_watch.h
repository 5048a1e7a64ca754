#pragma once

#include <utility>

#include "viewer/x11/x_connection.h"

namespace pixelflex::viewer {

/// Hears an X server's bell and of changes of its keyboard's layout, where the server can tell. The session's thread.
class XkbWatch {
 public:
  /// `connection` must outlive this.
  explicit XkbWatch(const XConnection& connection);

  void handle(const XEvent& event);
  /// It has rung since the last call.
  [[nodiscard]] bool takeRung() { return std::exchange(rung_, false); }
  /// The layout has changed since the last call. Whoever speaks XKEYBOARD is not told by the core protocol any more.
  [[nodiscard]] bool takeLayoutChange() { return std::exchange(layoutChanged_, false); }

 private:
  int keyboardEvent_ = -1;  // -1: it cannot be heard
  bool rung_ = false;
  bool layoutChanged_ = false;
};

}  // namespace pixelflex::viewer
