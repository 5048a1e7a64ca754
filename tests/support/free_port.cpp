#include "tests/support/free_port.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <random>
#include <stdexcept>

namespace pixelflex::testing {
namespace {

// Below 32768, where Linux begins to number the near ends of connections, and off the displays of X and VNC.
constexpr int kFirst = 12000;
constexpr int kLast = 32000;

bool isFree(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<in_port_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const bool bound = ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  ::close(socket);
  return bound;
}

}  // namespace

int freePort() {
  std::random_device random;
  std::uniform_int_distribution<int> ports(kFirst, kLast);
  for (int i = 0; i < 1000; ++i) {
    const int port = ports(random);
    if (isFree(port)) return port;
  }
  throw std::runtime_error("no free TCP port");
}

}  // namespace pixelflex::testing
