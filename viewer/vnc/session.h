#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/tiles/frame_belt.h"
#include "viewer/vnc/server_address.h"
#include "viewer/vnc/session_event.h"

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
  std::optional<std::string> password;
  /// For servers that ask who it is; never sent without encryption.
  std::string user;
  SecurityOptions security;
  /// Drops pointer, keys and clipboard before they reach the server.
  bool viewOnly = false;
  /// Keeps other viewers connected.
  bool shared = true;
  /// False: the server may send JPEG, which saves bandwidth and alters pixels.
  bool lossless = true;
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

/// A connection to a VNC server, on a thread of its own. That thread connects, decodes into one linear frame buffer and
/// puts each whole server update on the belt; it is the only one that reads or writes the socket. Every member may be
/// called from any thread. Nothing throws because of the server: whatever ends the connection arrives as a Lost event,
/// and Connected again when the server is back, or as a Closed event. Input while there is no connection is dropped,
/// and what was held down when it broke is let go on the next one. The destructor stops and waits for the thread, a
/// fraction of a second at most, whatever the server does.
class Session {
 public:
  /// Starts at once. `belt` must outlive the session. `wake` is called from the session's thread after each new event
  /// (the belt has its own) and must not call the session's destructor.
  Session(SessionOptions options, FrameBelt& belt, std::function<void()> wake);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// The events since the last call, oldest first.
  [[nodiscard]] std::vector<SessionEvent> takeEvents();

  /// Desktop pixels; bit 0 of `buttons` is the left button, bits 3 and 4 the wheel. A motion that has not been sent yet
  /// is replaced by the next one with the same buttons. Outside the desktop the position is clamped.
  void sendPointer(int x, int y, std::uint8_t buttons);
  /// An X11 keysym.
  void sendKey(std::uint32_t keysym, bool down);
  /// UTF-8; what Latin-1 cannot hold becomes a question mark. Texts beyond 256 KiB are cut there.
  void sendClipboard(std::string text);

  /// Ends the connection without a Closed event and returns at once. Input is ignored from here on.
  void stop();

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace pixelflex::viewer
