#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewer/tiles/region.h"
#include "viewer/vnc/clipboard_messages.h"
#include "viewer/vnc/jpeg_workers.h"
#include "viewer/vnc/rfb_failure.h"
#include "viewer/vnc/rfb_log.h"
#include "viewer/vnc/session.h"
#include "viewer/vnc/tls_session.h"

struct _rfbClient;  // NOLINT(bugprone-reserved-identifier): libvncclient's name

namespace pixelflex::viewer {

struct RfbScreen {
  std::uint32_t id = 0;
  Box box;
  bool operator==(const RfbScreen&) const = default;
};

/// A libvncclient client on a connected socket, and what it and its reader know.
struct RfbState {
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };
  using Pixels = std::unique_ptr<std::uint8_t, Free>;

  /// `socket` and `options` stay the caller's and must outlive this.
  RfbState(int socket, const SessionOptions& options);
  ~RfbState();
  RfbState(const RfbState&) = delete;
  RfbState& operator=(const RfbState&) = delete;

  void read(std::span<std::uint8_t> bytes) const;
  void discard(std::uint64_t count) const;
  /// The next bytes to be read, before those that the server has sent.
  void giveBack(std::span<const std::uint8_t> bytes);
  /// A server that takes nothing for as long as the session is patient is an error.
  void write(std::span<const std::uint8_t> message) const;
  /// Throws what the log tells.
  [[noreturn]] void fail() const;
  /// Throws that the server did something that makes no sense: "sent …".
  [[noreturn]] void refuse(const std::string& what) const;

  /// Until everything that was sent is in the frame buffer; refuses damaged pictures.
  void finishPictures();

  /// Of the whole desktop: what has changed, or everything.
  void requestUpdate(bool incremental) const;
  /// From here on the server sends updates of the whole desktop without being asked.
  void enableContinuousUpdates();
  /// Gives libvncclient a frame buffer of this size. What was shown stays shown until the server has sent the new
  /// picture. Throws SessionError for sizes that cannot be.
  void resize(devices::Size size);
  /// From here on a read ends with an error when nothing comes for as long as the session is patient.
  void limitReading() const;
  /// The damage is the first pixel and nothing else, and that has the colour that it had when this was last called.
  [[nodiscard]] bool isOnlySignOfLife();

  RfbLog log;
  const SessionOptions& options;
  std::string where;  // describeServer()
  std::string desktopName;
  ConnectionSecurity security;
  std::unique_ptr<TlsSession> tls;  // libvncclient reads and writes through it; null: in the clear
  _rfbClient* client = nullptr;
  Pixels pixels;
  devices::Size pixelsSize;
  JpegWorkers jpegWorkers;                                // after what they write to
  std::optional<std::array<std::uint8_t, 3>> firstPixel;  // as of the last update of this frame buffer
  Region damage;
  bool insideUpdate = false;
  bool updateFinished = false;
  bool everUpdated = false;
  bool pointerUsed = false;   // this session has put it somewhere
  bool pointerDrawn = false;  // by the server, into the desktop
  bool continuousUpdates = false;
  LinkSettings link;
  bool hasFences = false;
  std::optional<std::chrono::steady_clock::time_point> pinged;  // and not answered yet
  std::optional<std::chrono::nanoseconds> roundTrip;            // the shortest
  std::optional<std::vector<RfbScreen>> screens;                // once the server has told of them
  std::optional<ScreenLayout> wantedLayout;                     // not asked for yet
  bool extendedButtons = false;                                 // it takes buttons beyond the seventh
  std::optional<ClipboardCaps> clipboardCaps;                   // of a server with the Extended Clipboard
  std::optional<std::string> offeredText;                       // the last text copied here, UTF-8
  std::vector<SessionEvent> events;

 private:
  [[nodiscard]] std::size_t writeOnce(std::span<const std::uint8_t> bytes) const;
  void adopt(Pixels fresh, devices::Size size);

  // As much as libvncclient reads ahead, and the head of a message before it.
  std::array<std::uint8_t, 8192 + 16> givenBack_{};
};

}  // namespace pixelflex::viewer
