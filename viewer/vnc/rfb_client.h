#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/tiles/region.h"
#include "viewer/vnc/input_queue.h"
#include "viewer/vnc/session.h"
#include "viewer/vnc/update_publisher.h"
#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {

struct RfbState;

/// The protocol: libvncclient on one connected socket, on one thread. Calls block until the server has said enough;
/// shutting the socket down from another thread ends them. Whatever goes wrong throws SessionError.
class RfbClient {
 public:
  /// `socket` stays the caller's and must outlive the client.
  RfbClient(int socket, const SessionOptions& options, const LinkSettings& link = {});
  ~RfbClient();
  RfbClient(const RfbClient&) = delete;
  RfbClient& operator=(const RfbClient&) = delete;

  /// From the server's first byte to the request for the first picture. Throws SessionStopped too.
  void handshake(Deadline deadline, const Signal& stop);
  [[nodiscard]] std::string desktopName() const;
  [[nodiscard]] devices::Size desktop() const;
  [[nodiscard]] const ConnectionSecurity& security() const;

  /// True while bytes of a next message were read from the socket already: poll() does not see those.
  [[nodiscard]] bool hasBufferedBytes() const;
  /// Reads one message of the server. One that stops half way for longer than the session's patience is an error.
  void handleMessage();
  /// What the messages brought, oldest first: all but Connected and Closed.
  [[nodiscard]] std::vector<SessionEvent> takeEvents();
  /// Once per whole update: what it changed. The view stays valid until the next message.
  [[nodiscard]] std::optional<Region> takeFinishedUpdate();
  [[nodiscard]] FrameView frame() const;

  void send(const Input& input);
  /// Asks for other compression.
  void setLink(const LinkSettings& link);
  /// Asks for an answer that tells how far the server is. False when it gives none, or one is still on its way.
  bool ping();
  /// The quickest answer so far.
  [[nodiscard]] std::optional<std::chrono::nanoseconds> roundTrip() const;
  /// Asks for the desktop's first pixel. An answer with the colour that it had is no damage.
  void askForSignOfLife();
  /// Throws what to say of a server that does not answer.
  [[noreturn]] void giveUp() const;
  /// When the server draws the pointer into the desktop although nobody else uses it, takes it over, once.
  void claimPointer();

 private:
  std::unique_ptr<RfbState> state_;
};

}  // namespace pixelflex::viewer
