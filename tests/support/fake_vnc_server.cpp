#include "tests/support/fake_vnc_server.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

namespace pixelflex::testing {
namespace {

constexpr std::chrono::milliseconds kPatience{10'000};

int listenAt(const sockaddr* address, socklen_t length) {
  const int socket = ::socket(address->sa_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (::bind(socket, address, length) != 0 || ::listen(socket, 4) != 0) throw std::runtime_error("cannot listen");
  return socket;
}

int listenUnix(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  return listenAt(reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

int listenTcp() {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return listenAt(reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

int portOf(int socket) {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length);
  return ntohs(address.sin_port);
}

bool readable(int socket, std::chrono::milliseconds time) {
  pollfd watched{socket, POLLIN, 0};
  return ::poll(&watched, 1, static_cast<int>(time.count())) > 0;
}

}  // namespace

Message& Message::number(std::uint32_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) bytes_.push_back(static_cast<std::uint8_t>(value >> shift));
  return *this;
}

Message& Message::text(std::string_view characters) {
  for (const char c : characters) bytes_.push_back(static_cast<std::uint8_t>(c));
  return *this;
}

Message& Message::repeat(std::uint8_t byte, std::size_t count) {
  bytes_.resize(bytes_.size() + count, byte);
  return *this;
}

Message& Message::append(const Message& other) {
  bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end());
  return *this;
}

Message& Message::rect(int x, int y, int w, int h, std::int32_t encoding) {
  for (const int value : {x, y, w, h}) u16(static_cast<std::uint32_t>(value));
  return s32(encoding);
}

void FakeConnection::send(const Message& message) const {
  std::size_t sent = 0;
  while (sent < message.bytes().size()) {
    const ssize_t part = ::send(socket_, &message.bytes()[sent], message.bytes().size() - sent, MSG_NOSIGNAL);
    if (part <= 0) throw ClientGone{};
    sent += static_cast<std::size_t>(part);
  }
}

std::vector<std::uint8_t> FakeConnection::receive(std::size_t count) const {
  std::vector<std::uint8_t> bytes(count);
  for (std::size_t got = 0; got < count;) {
    if (!readable(socket_, kPatience)) throw ClientGone{};
    const ssize_t part = ::recv(socket_, &bytes[got], count - got, 0);
    if (part <= 0) throw ClientGone{};
    got += static_cast<std::size_t>(part);
  }
  return bytes;
}

void FakeConnection::drain(std::chrono::milliseconds time) const {
  const auto deadline = std::chrono::steady_clock::now() + time;
  std::array<char, 4096> bin{};
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0 || !readable(socket_, left)) return;
    if (::recv(socket_, bin.data(), bin.size(), 0) <= 0) return;
  }
}

Message FakeConnection::greeting(devices::Size desktop, const std::string& name) {
  Message message;
  message.text("RFB 003.008\n").u8(1).u8(1).u32(0);
  message.u16(static_cast<std::uint32_t>(desktop.width)).u16(static_cast<std::uint32_t>(desktop.height));
  message.u8(32).u8(24).u8(0).u8(1).u16(255).u16(255).u16(255).u8(16).u8(8).u8(0).repeat(0, 3);
  return message.u32(static_cast<std::uint32_t>(name.size())).text(name);
}

std::vector<std::uint8_t> FakeConnection::shakeHands(devices::Size desktop, const std::string& name) const {
  send(greeting(desktop, name));
  receive(12 + 1 + 1);  // version, security type, ClientInit
  receive(20);          // SetPixelFormat
  std::vector<std::uint8_t> encodings = receive(4);
  const std::vector<std::uint8_t> list = receive(std::size_t{4} * (std::size_t{encodings[2]} << 8 | encodings[3]));
  encodings.insert(encodings.end(), list.begin(), list.end());
  receive(10);  // FramebufferUpdateRequest
  return encodings;
}

FakeVncServer::FakeVncServer(Script script, Transport transport, int clients) : clients_(clients) {
  if (transport == Transport::kUnix) {
    const std::string path = (folder_ / "fake.sock").string();
    listener_ = listenUnix(path);
    address_ = "unix:" + path;
  } else {
    listener_ = listenTcp();
    address_ = "127.0.0.1::" + std::to_string(portOf(listener_));
  }
  thread_ = std::jthread([this, script = std::move(script)] { serve(script); });
}

FakeVncServer::~FakeVncServer() {
  ::shutdown(listener_, SHUT_RDWR);  // ends a waiting accept()
  thread_.join();
  ::close(listener_);
}

void FakeVncServer::serve(const Script& script) const {
  for (int i = 0; i < clients_ && serveNext(script); ++i) {
  }
}

bool FakeVncServer::serveNext(const Script& script) const {
  const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  if (socket < 0) return false;
  FakeConnection connection(socket);
  try {
    script(connection);
    // A close with unread bytes would reset the connection and might lose what was sent last.
    ::shutdown(socket, SHUT_WR);
    connection.drain(kPatience);
  } catch (const FakeConnection::ClientGone&) {
    ::shutdown(socket, SHUT_RDWR);
  }
  ::close(socket);
  return true;
}

}  // namespace pixelflex::testing
