#include "tests/support_devices/scripted_server.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace pixelflex::testing {
namespace {

constexpr int kPollMs = 5;

bool hasInput(int descriptor) {
  pollfd waited{descriptor, POLLIN, 0};
  return ::poll(&waited, 1, kPollMs) > 0;
}

}  // namespace

ScriptedServer::ScriptedServer(std::function<std::string(const std::string&)> reply, int port)
    : reply_(std::move(reply)) {
  socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  ::setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<in_port_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (::bind(socket_, generic, size) != 0 || ::listen(socket_, 8) != 0 || ::getsockname(socket_, generic, &size) != 0) {
    throw std::runtime_error("no server: " + std::string(std::strerror(errno)));
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

ScriptedServer::~ScriptedServer() {
  stop_ = true;
  thread_.join();
  ::close(socket_);
}

std::string ScriptedServer::heard() const {
  const std::lock_guard lock(mutex_);
  return heard_;
}

void ScriptedServer::serve() {
  while (!stop_) {
    if (!hasInput(socket_)) continue;
    const int client = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
    ++clients_;
    hangUp_ = false;
    talk(client);
    ::close(client);
  }
}

void ScriptedServer::talk(int client) {
  while (!stop_ && !hangUp_) {
    if (!hasInput(client)) continue;
    std::array<char, 4096> buffer{};
    const auto count = ::recv(client, buffer.data(), buffer.size(), 0);
    if (count <= 0) return;
    const std::string bytes(buffer.data(), static_cast<std::size_t>(count));
    {
      const std::lock_guard lock(mutex_);
      heard_ += bytes;
    }
    const std::string answer = reply_(bytes);
    if (!answer.empty()) (void)::send(client, answer.data(), answer.size(), MSG_NOSIGNAL);
  }
}

}  // namespace pixelflex::testing
