#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "viewer/vnc/input_queue.h"
#include "viewer/vnc/session_event.h"
#include "viewer/x11/cursor_watch.h"
#include "viewer/x11/screen_capture.h"
#include "viewer/x11/x_clipboard.h"
#include "viewer/x11/x_keyboard.h"
#include "viewer/x11/x_pointer.h"
#include "viewer/x11/xkb_watch.h"

namespace pixelflex::viewer {

/// What goes to the server; all of it empty: it is only looked at.
struct LocalInput {
  bool pointerAndKeys = false;
  std::size_t clipboardLimit = 0;  // bytes of the longest text, either way; 0: no clipboard
  bool primary = false;            // the primary selection, too
};

/// The desktop of an X server on one connection: screen, pointer, keyboard, clipboard and bell. The session's thread.
class LocalDesktop {
 public:
  /// `connection` must outlive this.
  LocalDesktop(const XConnection& connection, const LocalInput& input);
  /// Lets go of all keys and buttons.
  ~LocalDesktop();
  LocalDesktop(const LocalDesktop&) = delete;
  LocalDesktop& operator=(const LocalDesktop&) = delete;

  [[nodiscard]] devices::Size size() const { return screen_.size(); }
  /// Takes what the server has to say: true when there was something.
  bool listen();
  void take(const Input& input);
  /// Has a look at the pointer, too, at the next takeEvents(). Now and then; the server tells of most motion.
  void lookForPointer() { cursor_.look(); }
  /// What has come about since the last call.
  [[nodiscard]] std::vector<SessionEvent> takeEvents();

  [[nodiscard]] bool damaged() const { return screen_.damaged(); }
  /// Puts what has changed onto the belt: at most sixty times a second, whatever is drawn.
  [[nodiscard]] std::chrono::steady_clock::time_point publishDue() const { return due_; }
  void publish(FrameBelt& belt, const std::stop_token& stop, std::uint64_t& serial);

 private:
  void addClipboard(Selection selection);
  void offer(const ClipboardInput& copied);

  const XConnection& connection_;
  ScreenCapture screen_;
  CursorWatch cursor_;
  XkbWatch xkb_;
  std::optional<XKeyboard> keyboard_;
  std::optional<XPointer> pointer_;
  std::size_t clipboardLimit_;
  std::map<Selection, XClipboard> clipboards_;
  devices::Size told_;
  std::chrono::steady_clock::time_point due_;
};

}  // namespace pixelflex::viewer
