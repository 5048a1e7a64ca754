#pragma once

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "devices/image/size.h"
#include "viewer/vnc/waiting.h"
#include "viewer/x11/x_display.h"

struct xcb_connection_t;

namespace pixelflex::viewer {

struct FreeMemory {
  void operator()(void* memory) const { std::free(memory); }
};
/// What libxcb has allocated.
template <class T>
using Owned = std::unique_ptr<T, FreeMemory>;

/// An event of the X server; its type says what it is.
class XEvent {
 public:
  explicit XEvent(void* event) : memory_(event) {}
  [[nodiscard]] int type() const { return *static_cast<const std::uint8_t*>(memory_.get()) & 0x7f; }
  template <class T>
  [[nodiscard]] const T& as() const {
    return *static_cast<const T*>(memory_.get());
  }

 private:
  Owned<void> memory_;
};

/// An extension's first event, and the opcode that marks its generic events.
struct XExtension {
  int firstEvent = 0;
  int opcode = 0;
};

/// A connection to an X server of this machine, on the session's thread. A server that does not answer within
/// `patience` or is gone makes every function throw SessionError (kLost), a raised `stop` SessionStopped.
class XConnection {
 public:
  /// Throws SessionError, also when there is no server, it refuses us or there is no such screen.
  XConnection(const XDisplay& display, const Signal& stop, std::chrono::milliseconds patience);

  [[nodiscard]] xcb_connection_t* get() const { return connection_.get(); }
  [[nodiscard]] const XDisplay& display() const { return display_; }
  [[nodiscard]] std::uint32_t root() const { return root_; }
  [[nodiscard]] int fd() const;
  [[nodiscard]] std::uint32_t newId() const;

  /// The reply to a request that was just sent; null when the server answered with an error.
  template <class Reply, class Cookie>
  [[nodiscard]] Owned<Reply> reply(Cookie cookie) const {
    return Owned<Reply>(static_cast<Reply*>(waitForReply(cookie.sequence)));
  }
  /// Never waits; nothing when there is none.
  [[nodiscard]] std::optional<XEvent> nextEvent() const;
  void flush() const;
  /// Waits a little until the server has read everything: it leaves unread what comes from a connection that was
  /// closed. Neither throws nor can be stopped.
  void settle() const noexcept;

  [[nodiscard]] std::uint32_t atom(const std::string& name) const;
  /// Nothing when the server does not have it.
  [[nodiscard]] std::optional<XExtension> findExtension(const std::string& name) const;
  /// Throws SessionError (kUnsupported) when the server does not have it.
  XExtension requireExtension(const std::string& name) const;
  [[noreturn]] void refuse(const std::string& why) const;

 private:
  struct Disconnect {
    void operator()(xcb_connection_t* connection) const;
  };

  void open(const XCookie& cookie);
  void findScreen();
  void* waitForReply(unsigned sequence) const;
  void requireConnection() const;

  XDisplay display_;
  const Signal& stop_;
  std::chrono::milliseconds patience_;
  std::unique_ptr<xcb_connection_t, Disconnect> connection_;
  std::uint32_t root_ = 0;
};

}  // namespace pixelflex::viewer
