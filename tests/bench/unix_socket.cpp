#include "tests/bench/unix_socket.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace pixelflex::testing {
namespace {

constexpr std::chrono::milliseconds kPatience{30'000};

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::generic_category().message(errno));
}

bool ready(int descriptor, short events, std::chrono::milliseconds time) {
  pollfd watched{descriptor, events, 0};
  return ::poll(&watched, 1, static_cast<int>(time.count())) > 0;
}

sockaddr_un addressOf(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) throw std::runtime_error(path + ": too long for a socket");
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

int opened() {
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) fail("socket");
  return descriptor;
}

}  // namespace

UnixSocket::~UnixSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

UnixSocket::UnixSocket(UnixSocket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

UnixSocket UnixSocket::connected(const std::string& path) {
  UnixSocket socket(opened());
  const sockaddr_un address = addressOf(path);
  if (::connect(socket.descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) fail(path);
  return socket;
}

UnixSocket UnixSocket::listening(const std::string& path) {
  UnixSocket socket(opened());
  const sockaddr_un address = addressOf(path);
  if (::bind(socket.descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) fail(path);
  if (::listen(socket.descriptor_, 1) != 0) fail(path);
  return socket;
}

UnixSocket UnixSocket::accept() const {
  if (!ready(descriptor_, POLLIN, kPatience)) throw std::runtime_error("no viewer connects");
  const int client = ::accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC);
  if (client < 0) fail("accept");
  return UnixSocket(client);
}

void UnixSocket::write(std::span<const std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const std::size_t sent = writeSome(bytes);
    bytes = bytes.subspan(sent);
    if (sent == 0) wait(true);
  }
}

std::size_t UnixSocket::writeSome(std::span<const std::uint8_t> bytes) const {
  const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent >= 0) return static_cast<std::size_t>(sent);
  if (errno == EAGAIN || errno == EINTR) return 0;
  fail("the other side of the socket");
}

void UnixSocket::wait(bool toWrite) const {
  const auto events = static_cast<short>(toWrite ? POLLIN | POLLOUT : POLLIN);
  if (!ready(descriptor_, events, kPatience)) throw std::runtime_error("the other side does nothing any more");
}

std::vector<std::uint8_t> UnixSocket::read(std::size_t count) const {
  std::vector<std::uint8_t> bytes(count);
  std::size_t have = 0;
  while (have < count) {
    if (!ready(descriptor_, POLLIN, kPatience)) throw std::runtime_error("the other side says nothing any more");
    const ssize_t got = ::recv(descriptor_, bytes.data() + have, count - have, 0);
    if (got == 0) throw std::runtime_error("the other side is gone");
    if (got < 0) fail("the other side of the socket");
    have += static_cast<std::size_t>(got);
  }
  return bytes;
}

std::vector<std::uint8_t> UnixSocket::readSome(std::chrono::milliseconds time) const {
  if (!ready(descriptor_, POLLIN, time)) return {};
  std::array<std::uint8_t, 65536> bytes{};
  const ssize_t got = ::recv(descriptor_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (got == 0) throw std::runtime_error("the other side is gone");
  if (got < 0) fail("the other side of the socket");
  return {bytes.begin(), bytes.begin() + got};
}

}  // namespace pixelflex::testing
