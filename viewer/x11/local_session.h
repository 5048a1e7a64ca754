#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "viewer/tiles/frame_belt.h"
#include "viewer/vnc/desktop_source.h"
#include "viewer/vnc/session.h"
#include "viewer/x11/x_display.h"

namespace pixelflex::viewer {

struct LocalSessionOptions {
  XDisplay display;
  /// Drops pointer, keys and clipboard before they reach the server, and leaves its clipboard unread.
  bool viewOnly = false;
  /// The longest text that is taken from the desktop's clipboard or put there, in bytes. 0: no clipboard.
  std::size_t clipboardLimit = std::size_t{1} << 20;
  /// What is marked with the mouse goes both ways as well.
  bool primary = true;
  /// A server that does not answer for so long counts as lost.
  std::chrono::milliseconds patience{9'000};
  Retry retry = Retry::kNever;
};

/// The desktop of an X server of this machine, without any codec: the server tells what was damaged and writes it into
/// memory that both share (DAMAGE, MIT-SHM), tells of its pointer, clipboard (XFIXES) and bell (XKEYBOARD) and takes
/// pointer and keys as if they came from its own devices (XTEST). Its true colours must have 8 bits each.
class LocalSession : public DesktopSource {
 public:
  /// Starts at once. `belt` must outlive the session. `wake` is called from the session's thread after each new event
  /// (the belt has its own) and must not call the session's destructor.
  LocalSession(LocalSessionOptions options, FrameBelt& belt, std::function<void()> wake);
  ~LocalSession() override;

  [[nodiscard]] std::vector<SessionEvent> takeEvents() override;
  void sendPointer(int x, int y, std::uint16_t buttons) override;
  void sendKey(std::uint32_t keysym, bool down) override;
  void sendClipboard(std::string text, Selection selection) override;
  void stop() override;

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace pixelflex::viewer
