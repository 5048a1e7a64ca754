#include "tests/fuzz/vnc_entry.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <string>
#include <system_error>

#include "viewer/vnc/rfb_client.h"
#include "viewer/vnc/session_error.h"

namespace pixelflex::testing {
namespace {

using viewer::FileDescriptor;

struct Link {
  FileDescriptor client;
  FileDescriptor server;
};

Link makeLink() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::system_error(errno, std::generic_category(), "socketpair");
  }
  return {FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

// As much as the socket holds, and then the end.
void say(int socket, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent <= 0) break;
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  ::shutdown(socket, SHUT_WR);
}

// Nobody reads what the client answers.
void forget(int socket) {
  std::array<char, 4096> bin{};
  while (::recv(socket, bin.data(), bin.size(), MSG_DONTWAIT) > 0) {
  }
}

void requireInside(const viewer::Region& damage, const viewer::FrameView& frame) {
  for (const viewer::Box& box : damage.boxes()) {
    const bool inside =
        box.left >= 0 && box.top >= 0 && box.right <= frame.size.width && box.bottom <= frame.size.height;
    if (!inside) throw std::logic_error("damage outside the desktop");
  }
}

[[noreturn]] void converse(const Link& link, const viewer::SessionOptions& options, int& updates) {
  using namespace std::chrono_literals;
  const viewer::Signal stop;
  viewer::RfbClient client(link.client.get(), options);
  client.handshake(std::chrono::steady_clock::now() + 1s, stop);
  while (true) {
    client.handleMessage();
    client.claimPointer();
    (void)client.takeEvents();
    const auto damage = client.takeFinishedUpdate();
    if (damage) requireInside(*damage, client.frame());
    updates += damage ? 1 : 0;
    forget(link.server.get());
  }
}

}  // namespace

int hearServer(std::span<const std::uint8_t> bytes) {
  viewer::SessionOptions options;
  options.server.socketPath = "fuzz";
  options.user = "operator";
  options.password = "secret";
  options.patience = std::chrono::milliseconds(1);
  const Link link = makeLink();
  say(link.server.get(), bytes);
  int updates = 0;
  try {
    converse(link, options, updates);
  } catch (const viewer::SessionError& error) {
    if (std::string(error.what()).empty()) throw std::logic_error("an end without a message");
  }
  return updates;
}

}  // namespace pixelflex::testing
