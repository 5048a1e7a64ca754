#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "viewer/vnc/screen_layout.h"
#include "viewer/vnc/session_event.h"

namespace pixelflex::viewer {

/// A desktop that lives elsewhere: where its pixels come from (they go onto a FrameBelt given at construction) and
/// where pointer, keys and texts go. Works on a thread of its own from construction to destruction; every member may be
/// called from any thread. Nothing throws because of the other side: whatever ends the connection arrives as a Lost
/// event, and Connected again when the desktop is back, or as a Closed event. Input while there is no connection is
/// dropped, and what was held down when it broke is let go on the next one. The destructor stops and waits for the
/// thread, a fraction of a second at most, whatever the other side does.
class DesktopSource {
 public:
  DesktopSource() = default;
  virtual ~DesktopSource() = default;
  DesktopSource(const DesktopSource&) = delete;
  DesktopSource& operator=(const DesktopSource&) = delete;

  /// The events since the last call, oldest first.
  [[nodiscard]] virtual std::vector<SessionEvent> takeEvents() = 0;

  /// Desktop pixels; bit 0 of `buttons` is the left button, bits 3 to 6 the wheel, bits 7 and 8 the side
  /// buttons, which not all servers take. A motion that has not been sent yet is replaced by the next one with the same
  /// buttons. Outside the desktop the position is clamped.
  virtual void sendPointer(int x, int y, std::uint16_t buttons) = 0;
  /// An X11 keysym.
  virtual void sendKey(std::uint32_t keysym, bool down) = 0;
  /// UTF-8. Where there is one clipboard only, as with VNC, the last text is in it.
  virtual void sendClipboard(std::string text, Selection selection) = 0;
  void sendClipboard(std::string text) { sendClipboard(std::move(text), Selection::kClipboard); }

  /// Asks the connected desktop for a size and screens: a Resized or a ResizeRefused event follows, or nothing when it
  /// has them already. False when this kind of desktop cannot be asked.
  [[nodiscard]] virtual bool requestLayout(ScreenLayout layout) {
    (void)layout;
    return false;
  }

  /// Ends the connection without a Closed event and returns at once. Input is ignored from here on.
  virtual void stop() = 0;
};

}  // namespace pixelflex::viewer
