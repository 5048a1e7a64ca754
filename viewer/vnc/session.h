#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/tiles/frame_belt.h"
#include "viewer/vnc/desktop_source.h"
#include "viewer/vnc/link.h"
#include "viewer/vnc/secret.h"
#include "viewer/vnc/server_address.h"

namespace pixelflex::viewer {

/// The largest desktop, each way: TigerVNC's own limit, and the most that libvncclient's 31-bit sizes can hold.
inline constexpr int kMaxDesktopExtent = 16384;

enum class Retry {
  kNever,
  kLost,    // once the desktop was there; a first connection that fails ends the session
  kAlways,  // a server that is not there yet is waited for, too
};

struct SessionOptions {
  ServerAddress server;
  /// For servers that ask for one; VNC's own scheme looks at its first eight characters only.
  std::optional<Secret> password;
  /// For servers that ask who it is; never sent without encryption.
  std::string user;
  SecurityOptions security;
  /// Drops pointer, keys and clipboard before they reach the server.
  bool viewOnly = false;
  /// requestLayout() works, unless only viewing.
  bool mayResize = false;
  /// The longest text that is taken from the server's clipboard or offered to it, in bytes; longer ones are left out.
  /// 0: no clipboard.
  std::size_t clipboardLimit = std::size_t{1} << 20;
  /// Keeps other viewers connected.
  bool shared = true;
  /// False: over a link that is not local the server may send JPEG, which saves bandwidth and alters pixels.
  bool lossless = true;
  Link link = Link::kAuto;
  /// With kAuto, a connection within this machine is local. False: it may be the end of a tunnel, and is measured.
  bool loopbackIsLocal = true;
  /// TigerVNC's server draws the pointer into the desktop for every viewer but the one that put it where it is. Set,
  /// the session puts it into the middle of the desktop when it connects to such a server, where it is on a fresh
  /// desktop anyway, and the picture is clean. Not when only viewing.
  bool claimPointer = true;
  /// For the connection, and once more for the handshake.
  std::chrono::milliseconds connectTimeout{10'000};
  /// A server that says nothing for so long, although it is asked in between, counts as lost; before its first picture
  /// three times as long. Not less than 1.2 s.
  std::chrono::milliseconds patience{9'000};
  /// When the connection breaks. What cannot heal by itself (a refused password, a desktop too large) ends the session.
  Retry retry = Retry::kNever;
};

/// A connection to a VNC server. Its thread connects, decodes into one linear frame buffer and puts each whole server
/// update on the belt; it is the only one that reads or writes the socket.
class Session : public DesktopSource {
 public:
  /// Starts at once. `belt` must outlive the session. `wake` is called from the session's thread after each new event
  /// (the belt has its own) and must not call the session's destructor.
  Session(SessionOptions options, FrameBelt& belt, std::function<void()> wake);
  ~Session() override;

  [[nodiscard]] std::vector<SessionEvent> takeEvents() override;
  void sendPointer(int x, int y, std::uint16_t buttons) override;
  void sendKey(std::uint32_t keysym, bool down) override;
  /// To servers without the Extended Clipboard it goes as Latin-1: what that cannot hold becomes a question mark, and
  /// texts beyond 256 KiB stay here.
  void sendClipboard(std::string text, Selection selection) override;
  [[nodiscard]] bool requestLayout(ScreenLayout layout) override;
  void stop() override;

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace pixelflex::viewer
