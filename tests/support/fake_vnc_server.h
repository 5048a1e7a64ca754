#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "devices/image/size.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {

/// Bytes of a message, in network order.
class Message {
 public:
  Message& u8(std::uint32_t value) { return number(value, 1); }
  Message& u16(std::uint32_t value) { return number(value, 2); }
  Message& u32(std::uint32_t value) { return number(value, 4); }
  Message& s32(std::int32_t value) { return number(static_cast<std::uint32_t>(value), 4); }
  Message& text(std::string_view characters);
  Message& repeat(std::uint8_t byte, std::size_t count);
  Message& append(const Message& other);
  /// The head of a FramebufferUpdate.
  Message& update(std::uint32_t rectangles) { return u8(0).u8(0).u16(rectangles); }
  /// The head of a rectangle.
  Message& rect(int x, int y, int w, int h, std::int32_t encoding);

  [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  Message& number(std::uint32_t value, int bytes);

  std::vector<std::uint8_t> bytes_;
};

/// The server's side of one connection. Reading gives up after some seconds or when the client is gone; then, as when
/// writing fails, ClientGone is thrown, which ends the script quietly.
class FakeConnection {
 public:
  struct ClientGone {};

  explicit FakeConnection(int socket) : socket_(socket) {}
  [[nodiscard]] int socket() const { return socket_; }
  void send(const Message& message) const;
  std::vector<std::uint8_t> receive(std::size_t count) const;
  /// Reads and forgets until the client closes or `time` is up.
  void drain(std::chrono::milliseconds time) const;

  /// What a server without password says up to the client's first request: version, security, ServerInit.
  [[nodiscard]] static Message greeting(devices::Size desktop, const std::string& name = "fake");
  /// The whole handshake, in step with the client; returns the SetEncodings message.
  std::vector<std::uint8_t> shakeHands(devices::Size desktop, const std::string& name = "fake") const;

 private:
  int socket_;
};

/// A VNC server that says exactly what a test wants: listens on a UNIX socket or a TCP port of 127.0.0.1, and plays its
/// script to the first client, or to the first few, one after the other, on a thread of its own; closes the connection
/// at the script's end.
class FakeVncServer {
 public:
  using Script = std::function<void(FakeConnection&)>;
  enum class Transport { kUnix, kTcp };

  explicit FakeVncServer(Script script, Transport transport = Transport::kUnix, int clients = 1);
  ~FakeVncServer();
  FakeVncServer(const FakeVncServer&) = delete;
  FakeVncServer& operator=(const FakeVncServer&) = delete;

  /// As users write it.
  [[nodiscard]] const std::string& address() const { return address_; }

 private:
  void serve(const Script& script) const;
  [[nodiscard]] bool serveNext(const Script& script) const;

  TemporaryFolder folder_;
  std::string address_;
  int clients_;
  int listener_ = -1;
  std::jthread thread_;
};

}  // namespace pixelflex::testing
