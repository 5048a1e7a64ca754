#pragma once

#include <optional>
#include <string>

#include "viewer/x11/selection_owner.h"
#include "viewer/x11/selection_reader.h"

namespace pixelflex::viewer {

/// The clipboard of an X server, both ways; the primary selection, which follows the mouse, stays alone. The session's
/// thread.
class XClipboard {
 public:
  /// `connection` must outlive this and have been asked for XFixes before.
  explicit XClipboard(const XConnection& connection);

  void handle(const XEvent& event);
  /// UTF-8, for those on the desktop who paste.
  void offer(std::string text) { owner_.offer(std::move(text)); }
  /// UTF-8, what was copied on the desktop; each text once.
  [[nodiscard]] std::optional<std::string> takeText() { return reader_.takeText(); }

 private:
  SelectionAtoms atoms_;
  std::uint32_t window_;
  SelectionReader reader_;
  SelectionOwner owner_;
};

}  // namespace pixelflex::viewer
