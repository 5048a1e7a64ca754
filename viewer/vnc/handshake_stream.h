#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "viewer/vnc/tls_session.h"
#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {

/// A connected socket during the handshake, plain at first and encrypted later. Reads exactly what is asked for, so
/// that somebody else can read on. Every call returns by the deadline: then, and when the server hangs up, it throws
/// SessionError; SessionStopped when told to stop. Numbers are in network order.
class HandshakeStream {
 public:
  /// `socket`, which may block or not, and `stop` stay the caller's; `where` is describeServer().
  HandshakeStream(int socket, std::string where, Deadline deadline, const Signal& stop);

  [[nodiscard]] std::vector<std::uint8_t> read(std::size_t count);
  [[nodiscard]] std::uint32_t readNumber(int bytes);
  /// A length and as many bytes, of which those beyond `most` are left unread.
  [[nodiscard]] std::string readText(std::size_t most);
  /// The first bytes, at most `count`; may return fewer, but not none.
  [[nodiscard]] std::string readSome(std::size_t count);
  void write(std::span<const std::uint8_t> bytes);
  void writeNumber(std::uint32_t value, int bytes);

  /// Throws SessionError (kUntrusted) when the server and GnuTLS do not agree.
  void encrypt(TlsSession::Kind kind, const std::string& hostName);
  /// Null when plain.
  [[nodiscard]] TlsSession* tls() { return tls_.get(); }
  [[nodiscard]] std::unique_ptr<TlsSession> takeTls() { return std::move(tls_); }

  [[nodiscard]] const std::string& where() const { return where_; }

 private:
  std::size_t readOnce(std::span<std::uint8_t> bytes);
  std::size_t writeOnce(std::span<const std::uint8_t> bytes);
  void wait(short events);

  int socket_;
  std::string where_;
  Deadline deadline_;
  const Signal& stop_;
  std::unique_ptr<TlsSession> tls_;
};

}  // namespace pixelflex::viewer
