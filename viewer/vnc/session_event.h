#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "devices/image/size.h"
#include "viewer/vnc/security.h"

namespace pixelflex::viewer {

/// The handshake is done; the first picture follows on the belt. Again after each Lost.
struct Connected {
  std::string name;  // as the server calls its desktop, UTF-8
  devices::Size size;
  ConnectionSecurity security;
  bool operator==(const Connected&) const = default;
};

struct Resized {
  devices::Size size;
  bool operator==(const Resized&) const = default;
};

/// The desktop keeps its size although another was asked for.
struct ResizeRefused {
  std::string message;  // for people
  bool operator==(const ResizeRefused&) const = default;
};

/// The pointer's picture, which is not part of the desktop's: whoever shows the desktop draws it on top.
struct CursorShape {
  devices::Size size;              // 0x0: hidden, or TigerVNC draws it into the desktop, see SessionOptions
  int hotX = 0, hotY = 0;          // the pixel that points
  std::vector<std::uint8_t> rgba;  // row by row, four bytes a pixel, alpha straight (not premultiplied)
  bool operator==(const CursorShape&) const = default;
};

/// The pointer was moved by somebody else, in desktop pixels.
struct CursorMoved {
  int x = 0, y = 0;
  bool operator==(const CursorMoved&) const = default;
};

/// What the connection carries has changed how the server is asked to compress.
struct LinkChanged {
  std::string message;  // for people
  bool operator==(const LinkChanged&) const = default;
};

struct Bell {
  bool operator==(const Bell&) const = default;
};

enum class Selection {
  kClipboard,  // what is copied and pasted
  kPrimary,    // what is marked with the mouse and pasted with its middle button, on X desktops
};

/// Text was copied on the desktop. VNC knows the clipboard only.
struct Clipboard {
  std::string text;  // UTF-8
  Selection selection = Selection::kClipboard;
  bool operator==(const Clipboard&) const = default;
};

/// A text stays where it was copied, as it is too long.
struct ClipboardRefused {
  bool onDesktop = false;  // that is where
  std::size_t limit = 0;   // bytes
  bool operator==(const ClipboardRefused&) const = default;
};

enum class CloseKind {
  kUnreachable,     // no such host, nothing listens there, no answer
  kNotVnc,          // something answers, but not a VNC server
  kPasswordNeeded,  // the server asks for a password or a user that were not given
  kAuthentication,  // the password is wrong, or the server will not have us
  kUntrusted,       // the connection or the server's certificate is less than what is required
  kTooLarge,        // the desktop's size is not supported
  kLost,            // the server or the network ended the connection
  kUnsupported,     // the server is not one that can be used
  kProtocol,        // the server sent something that makes no sense
};

/// The server is gone or cannot be reached; the session tries again by itself. Once for each loss, however many
/// attempts follow.
struct Lost {
  CloseKind kind = CloseKind::kLost;
  std::string message;  // as Closed's
  bool operator==(const Lost&) const = default;
};

/// The last event of a session.
struct Closed {
  CloseKind kind = CloseKind::kLost;
  std::string message;  // for people: what is wrong, where, what to do
  bool operator==(const Closed&) const = default;
};

using SessionEvent = std::variant<Connected, Resized, ResizeRefused, CursorShape, CursorMoved, LinkChanged, Bell,
                                  Clipboard, ClipboardRefused, Lost, Closed>;

}  // namespace pixelflex::viewer
