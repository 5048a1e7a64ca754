#include "tests/support/tcp_talk.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <stdexcept>
#include <utility>

namespace pixelflex::testing {
namespace {

constexpr std::chrono::seconds kPatience{60};

}  // namespace

TcpTalk::TcpTalk(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0) return;
  ::close(socket_);
  throw std::runtime_error("nobody listens at port " + std::to_string(port));
}

TcpTalk::~TcpTalk() {
  ::close(socket_);
}

void TcpTalk::send(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;  // it has hung up: what it said is still to be read
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

bool TcpTalk::more() {
  pollfd watched{socket_, POLLIN, 0};
  const auto patience = std::chrono::duration_cast<std::chrono::milliseconds>(kPatience);
  if (::poll(&watched, 1, static_cast<int>(patience.count())) <= 0) {
    throw std::runtime_error("nothing more came after \"" + unread_ + "\"");
  }
  std::array<char, 4096> bytes{};
  const ssize_t got = ::recv(socket_, bytes.data(), bytes.size(), 0);
  if (got > 0) unread_.append(bytes.data(), static_cast<std::size_t>(got));
  return got > 0;
}

std::string TcpTalk::readUntil(std::string_view end) {
  while (unread_.find(end) == std::string::npos) {
    if (!more()) throw std::runtime_error("the connection was closed after \"" + unread_ + "\"");
  }
  return readBytes(unread_.find(end) + end.size());
}

std::string TcpTalk::readBytes(std::size_t count) {
  while (unread_.size() < count) {
    if (!more()) throw std::runtime_error("the connection was closed after \"" + unread_ + "\"");
  }
  const std::string bytes = unread_.substr(0, count);
  unread_.erase(0, count);
  return bytes;
}

std::string TcpTalk::readAll() {
  while (more()) {
  }
  return std::exchange(unread_, {});
}

std::string httpExchange(int port, const std::string& method, const std::string& target, const std::string& body,
                         const std::string& extra) {
  TcpTalk talk(port);
  const bool hasHost = extra.find("Host:") != std::string::npos;
  const bool hasType = extra.find("Content-Type:") != std::string::npos;
  talk.send(method + " " + target + " HTTP/1.1\r\n" + (hasHost ? "" : "Host: localhost\r\n") +
            (hasType ? "" : "Content-Type: application/json\r\n") + extra +
            "Content-Length: " + std::to_string(body.size()) + "\r\nConnection: close\r\n\r\n" + body);
  return talk.readAll();
}

}  // namespace pixelflex::testing
