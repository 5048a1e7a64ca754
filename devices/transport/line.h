#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "devices/transport/line_address.h"
#include "devices/transport/line_error.h"

namespace pixelflex::devices {

class LineLoop;

/// How many bytes at the front of what was received are the reply; nothing while it is not whole yet. Called on the
/// loop's thread.
using ReplyEnd = std::function<std::optional<std::size_t>(std::string_view received)>;

/// The reply ends with the first `terminator`.
[[nodiscard]] ReplyEnd untilText(std::string terminator);

/// One request and its reply.
struct Exchange {
  std::string bytes;  // may be empty: only listen
  ReplyEnd end;       // empty: there is no reply
  std::chrono::milliseconds timeout{500};
  bool urgent = false;       // goes before all that wait and breaks off what is under way, as a halt must
  bool keepEarlier = false;  // what came unasked before is part of the reply, as a greeting is
};

struct LineOptions {
  std::string device;                    // for messages: "p1's mirror"
  std::string resync;                    // sent after a reply that did not come whole, to end a half-typed command
  std::chrono::milliseconds quiet{100};  // silence after which the line counts as empty again
  std::chrono::milliseconds connectTimeout{3000};
  std::chrono::milliseconds idleClose{0};  // closed when nothing was asked for so long; 0: never
  std::chrono::milliseconds gap{0};        // least time from a reply to the next request
};

/// A line to one device: requests wait in a queue, one is under way, each has a deadline; the connection is made when
/// it is first needed and again, with growing pauses, when it was lost. Thread-safe. Nothing here waits on another
/// line.
class Line {
 public:
  using Answer = std::variant<std::string, LineProblem>;

  Line(LineLoop& loop, LineAddress address, LineOptions options);
  /// Requests that still wait are answered with kInterrupted.
  ~Line();
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  /// Waits for the reply, at most for those before it, a connection and its own timeout. Not on the loop's thread.
  /// Throws LineError.
  std::string ask(Exchange exchange);
  /// `done` is called once, on the loop's thread.
  void submit(Exchange exchange, std::function<void(Answer)> done);

  /// Ends the connection; the next request makes another.
  void disconnect();
  /// Counts connections made: what a device was told before may be forgotten when this changes.
  [[nodiscard]] std::uint64_t session() const;
  [[nodiscard]] bool isConnected() const;
  [[nodiscard]] const LineAddress& address() const;
  /// "p1's mirror at tcp://10.0.0.9:2101", for messages.
  [[nodiscard]] std::string name() const;

 private:
  class Engine;
  LineLoop* loop_;
  std::shared_ptr<Engine> engine_;
};

}  // namespace pixelflex::devices
