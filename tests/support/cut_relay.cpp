#include "tests/support/cut_relay.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace pixelflex::testing {
namespace {

using viewer::FileDescriptor;

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

int portOf(int socket) {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length);
  return ntohs(address.sin_port);
}

FileDescriptor makeSocket(int flags = 0) {
  FileDescriptor made(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | flags, 0));
  if (made.get() < 0) throw std::runtime_error("cannot make a socket");
  return made;
}

int connectTo(int socket, int port) {
  const sockaddr_in address = loopback(port);
  return ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

// False when either is gone.
bool handOver(int from, int to) {
  std::array<char, 65536> bytes{};
  const ssize_t count = ::recv(from, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count <= 0) return false;
  std::string_view left(bytes.data(), static_cast<std::size_t>(count));
  while (!left.empty()) {
    const ssize_t sent = ::send(to, left.data(), left.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    left.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

constexpr int kQueue = 16;

}  // namespace

CutRelay::CutRelay(int server) : server_(server), listener_(makeSocket(SOCK_NONBLOCK)) {
  const sockaddr_in address = loopback(0);
  if (::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener_.get(), kQueue) != 0) {
    throw std::runtime_error("cannot listen");
  }
  address_ = "127.0.0.1::" + std::to_string(portOf(listener_.get()));
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

CutRelay::~CutRelay() {
  thread_.request_stop();
  woken_.raise();
  thread_.join();
}

// A queue that is full has the kernel drop whatever asks for a connection.
void CutRelay::cut() {
  const std::scoped_lock lock(mutex_);
  cut_ = true;
  for (Pair& pair : pairs_) pair.dead = true;
  ::listen(listener_.get(), 0);
  for (int i = 0; i < 4; ++i) {
    FileDescriptor filler = makeSocket(SOCK_NONBLOCK);
    (void)connectTo(filler.get(), portOf(listener_.get()));
    fillers_.push_back(std::move(filler));
  }
  woken_.raise();
}

void CutRelay::heal() {
  const std::scoped_lock lock(mutex_);
  cut_ = false;
  fillers_.clear();
  ::listen(listener_.get(), kQueue);
  woken_.raise();
}

void CutRelay::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::vector<pollfd> watched{{woken_.fd(), POLLIN, 0}};
    {
      const std::scoped_lock lock(mutex_);
      std::erase_if(pairs_, [](const Pair& pair) { return pair.client.get() < 0; });
      if (!cut_) watched.push_back({listener_.get(), POLLIN, 0});
      for (const Pair& pair : pairs_) {
        if (pair.dead) continue;
        watched.push_back({pair.client.get(), POLLIN, 0});
        watched.push_back({pair.server.get(), POLLIN, 0});
      }
    }
    ::poll(watched.data(), watched.size(), -1);
    woken_.clear();
    const std::scoped_lock lock(mutex_);
    if (!cut_) accept();
    for (Pair& pair : pairs_) forward(pair);
  }
}

void CutRelay::accept() {
  FileDescriptor client(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
  if (client.get() < 0) return;
  FileDescriptor onward = makeSocket();
  if (connectTo(onward.get(), server_) != 0) return;
  // A reader that hangs must not hold the others for ever.
  const timeval patience{.tv_sec = 5, .tv_usec = 0};
  for (const int socket : {client.get(), onward.get()}) {
    ::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  }
  pairs_.push_back({std::move(client), std::move(onward)});
}

void CutRelay::forward(Pair& pair) {
  if (pair.dead) return;
  std::array<pollfd, 2> ends{{{pair.client.get(), POLLIN, 0}, {pair.server.get(), POLLIN, 0}}};
  ::poll(ends.data(), ends.size(), 0);
  const bool up = ends[0].revents == 0 || handOver(pair.client.get(), pair.server.get());
  const bool down = ends[1].revents == 0 || handOver(pair.server.get(), pair.client.get());
  if (up && down) return;
  pair.client = FileDescriptor();
  pair.server = FileDescriptor();
}

}  // namespace pixelflex::testing
