#pragma once

#include <string>
#include <string_view>

namespace pixelflex::testing {

/// A TCP connection of a test to a server of this machine, byte by byte. Written with plain sockets. Waits are generous
/// and end in std::runtime_error that says what had come until then.
class TcpTalk {
 public:
  explicit TcpTalk(int port);
  ~TcpTalk();
  TcpTalk(const TcpTalk&) = delete;
  TcpTalk& operator=(const TcpTalk&) = delete;

  void send(std::string_view bytes) const;
  /// Up to and with `end`; what comes after it waits for the next call.
  [[nodiscard]] std::string readUntil(std::string_view end);
  [[nodiscard]] std::string readBytes(std::size_t count);
  /// Until the other side closes, or resets.
  [[nodiscard]] std::string readAll();

 private:
  /// False at the end.
  bool more();

  int socket_ = -1;
  std::string unread_;
};

/// One HTTP request on a connection of its own, and the whole reply with its head. `extra` are header lines with their
/// ends.
[[nodiscard]] std::string httpExchange(int port, const std::string& method, const std::string& target,
                                       const std::string& body = {}, const std::string& extra = {});

}  // namespace pixelflex::testing
