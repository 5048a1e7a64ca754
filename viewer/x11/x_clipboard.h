#pragma once

#include <optional>
#include <string>

#include "viewer/vnc/session_event.h"
#include "viewer/x11/selection_owner.h"
#include "viewer/x11/selection_reader.h"

namespace pixelflex::viewer {

/// A clipboard of an X server, both ways. The session's thread.
class XClipboard {
 public:
  /// `connection` must outlive this and have been asked for XFixes before.
  XClipboard(const XConnection& connection, Selection selection, std::size_t limit);
  XClipboard(const XClipboard&) = delete;
  XClipboard& operator=(const XClipboard&) = delete;

  void handle(const XEvent& event);
  /// UTF-8, for those on the desktop who paste.
  void offer(std::string text) { owner_.offer(std::move(text)); }
  /// UTF-8, what was copied on the desktop; each text once.
  [[nodiscard]] std::optional<std::string> takeText() { return reader_.takeText(); }
  /// One was copied there that is longer than the limit.
  [[nodiscard]] bool takeTooLong() { return reader_.takeTooLong(); }

 private:
  SelectionAtoms atoms_;
  std::uint32_t window_;
  SelectionReader reader_;
  SelectionOwner owner_;
};

}  // namespace pixelflex::viewer
