#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewer/tiles/region.h"
#include "viewer/vnc/rfb_failure.h"
#include "viewer/vnc/rfb_log.h"
#include "viewer/vnc/session.h"
#include "viewer/vnc/tls_session.h"

struct _rfbClient;  // NOLINT(bugprone-reserved-identifier): libvncclient's name

namespace pixelflex::viewer {

/// A libvncclient client on a connected socket, and what its callbacks noted. libvncclient calls back through C, which
/// no exception may cross: the callbacks only note what happened, and the calls around them throw SessionError.
struct RfbState {
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };

  /// `socket` and `options` stay the caller's and must outlive this.
  RfbState(int socket, const SessionOptions& options);
  ~RfbState();
  RfbState(const RfbState&) = delete;
  RfbState& operator=(const RfbState&) = delete;

  void read(std::span<std::uint8_t> bytes) const;
  void discard(std::uint64_t count) const;
  void write(std::span<const std::uint8_t> message) const;
  /// Throws what a callback noted, or else what the log tells.
  [[noreturn]] void fail() const;

  /// Gives libvncclient a frame buffer of its present size; false and `failure` if that cannot be. What was shown stays
  /// shown until the server has sent the new picture.
  bool allocate() noexcept;
  /// From here on a read ends with an error when nothing comes for as long as the session is patient.
  void limitReading() const;
  /// The damage is the first pixel and nothing else, and that has the colour that it had when this was last called.
  [[nodiscard]] bool isOnlySignOfLife();
  void readAlphaCursor(devices::Size size, int hotX, int hotY);

  RfbLog log;
  const SessionOptions& options;
  std::string where;  // describeServer()
  std::string desktopName;
  ConnectionSecurity security;
  std::unique_ptr<TlsSession> tls;  // libvncclient reads and writes through it; null: in the clear
  _rfbClient* client = nullptr;
  std::unique_ptr<std::uint8_t, Free> pixels;
  devices::Size pixelsSize;
  std::optional<std::array<std::uint8_t, 3>> firstPixel;  // as of the last update of this frame buffer
  Region damage;
  bool insideUpdate = false;
  bool updateFinished = false;
  bool pointerUsed = false;   // this session has put it somewhere
  bool pointerDrawn = false;  // by the server, into the desktop
  bool pseudoRect = false;    // the next rectangle reported is none
  std::optional<SessionError> failure;
  std::vector<SessionEvent> events;
};

}  // namespace pixelflex::viewer
