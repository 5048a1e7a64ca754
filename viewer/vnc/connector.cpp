#include "viewer/vnc/connector.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <system_error>

#include "viewer/vnc/host_lookup.h"
#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {
namespace {

[[noreturn]] void fail(const std::string& message) {
  throw SessionError(CloseKind::kUnreachable, message);
}

std::string errorText(int error) {
  return std::generic_category().message(error);
}

FileDescriptor makeSocket(int family) {
  FileDescriptor socket(::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (socket.get() < 0) fail("cannot make a socket: " + errorText(errno));
  return socket;
}

// 0, or why not (an errno). The socket does not block, so that the wait can be cut short.
int connectSocket(int socket, const sockaddr* address, socklen_t length, Deadline deadline, const Signal& stop) {
  if (::connect(socket, address, length) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  if (!waitFor(socket, POLLOUT, deadline, stop)) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof error;
  if (::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) != 0) return errno;
  return error;
}

void setBlocking(int socket) {
  ::fcntl(socket, F_SETFL, ::fcntl(socket, F_GETFL) & ~O_NONBLOCK);
}

// Input must not wait for a full packet, and a link that died without a word must be noticed within ten seconds, idle
// or not.
void tuneTcp(int socket) {
  const auto set = [socket](int level, int option, int value) {
    ::setsockopt(socket, level, option, &value, sizeof value);
  };
  set(IPPROTO_TCP, TCP_NODELAY, 1);
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
  set(IPPROTO_TCP, TCP_KEEPIDLE, 3);
  set(IPPROTO_TCP, TCP_KEEPINTVL, 2);
  set(IPPROTO_TCP, TCP_KEEPCNT, 3);
  set(IPPROTO_TCP, TCP_USER_TIMEOUT, 9'000);
}

[[noreturn]] void explain(const ServerAddress& server, int error, std::chrono::milliseconds timeout) {
  const std::string where = describeServer(server);
  if (error == ECONNREFUSED) fail("nothing listens at " + where + ": is the server running?");
  if (error == ETIMEDOUT) {
    std::ostringstream seconds;
    seconds << std::chrono::duration<double>(timeout).count();
    fail("no answer from " + where + " within " + seconds.str() + " s");
  }
  fail("cannot connect to " + where + ": " + errorText(error));
}

FileDescriptor connectTcp(const ServerAddress& server, const ConnectLimits& limits, const Signal& stop) {
  const auto addresses = lookUpHost(server.host, server.port, std::chrono::steady_clock::now() + limits.lookUp, stop);
  const Deadline deadline = std::chrono::steady_clock::now() + limits.connect;
  int error = ETIMEDOUT;
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    const HostAddress& address = addresses[i];
    const Deadline now = std::chrono::steady_clock::now();
    // One that does not answer leaves time for the others.
    const Deadline turn = now + (deadline - now) / static_cast<std::int64_t>(addresses.size() - i);
    FileDescriptor socket = makeSocket(address.storage.ss_family);
    error =
        connectSocket(socket.get(), reinterpret_cast<const sockaddr*>(&address.storage), address.length, turn, stop);
    if (error != 0) continue;
    tuneTcp(socket.get());
    setBlocking(socket.get());
    return socket;
  }
  explain(server, error, limits.connect);
}

sockaddr_un unixAddress(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    fail("the socket's path is too long: " + path + " has " + std::to_string(path.size()) + " bytes, at most " +
         std::to_string(sizeof address.sun_path - 1) + " are possible");
  }
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

void requireSocketFile(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    if (errno == ENOENT) fail("there is no socket " + path + ": is the server running?");
    fail("cannot use the socket " + path + ": " + errorText(errno));
  }
  if (!S_ISSOCK(status.st_mode)) fail(path + " is not a socket: it must be the one given to the server");
}

FileDescriptor connectUnix(const ServerAddress& server, std::chrono::milliseconds timeout, const Signal& stop) {
  const sockaddr_un address = unixAddress(server.socketPath);
  requireSocketFile(server.socketPath);
  const Deadline deadline = std::chrono::steady_clock::now() + timeout;
  while (true) {
    FileDescriptor socket = makeSocket(AF_UNIX);
    const int error =
        connectSocket(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address, deadline, stop);
    if (error == 0) {
      setBlocking(socket.get());
      return socket;
    }
    if (error != EAGAIN) explain(server, error, timeout);
    // The server's queue of waiting clients is full, and a UNIX socket gives no event when that ends.
    const Deadline again = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
    if (again >= deadline) explain(server, ETIMEDOUT, timeout);
    waitFor(-1, 0, again, stop);
  }
}

}  // namespace

std::string describeServer(const ServerAddress& server) {
  if (server.isUnixSocket()) return "the socket " + server.socketPath;
  return server.host + " port " + std::to_string(server.port);
}

FileDescriptor connectToServer(const ServerAddress& server, const ConnectLimits& limits, const Signal& stop) {
  return server.isUnixSocket() ? connectUnix(server, limits.connect, stop) : connectTcp(server, limits, stop);
}

}  // namespace pixelflex::viewer
