#include "tests/support/udp_talk.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace pixelflex::testing {
namespace {

constexpr int kPatience = 60'000;  // milliseconds

sockaddr_in placeAt(int port) {
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return place;
}

}  // namespace

UdpTalk::UdpTalk() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in place = placeAt(0);
  socklen_t size = sizeof place;
  if (::bind(socket_, reinterpret_cast<const sockaddr*>(&place), size) != 0 ||
      ::getsockname(socket_, reinterpret_cast<sockaddr*>(&place), &size) != 0) {
    throw std::runtime_error("no UDP port is free");
  }
  port_ = ntohs(place.sin_port);
}

UdpTalk::~UdpTalk() {
  ::close(socket_);
}

void UdpTalk::send(int port, std::string_view bytes) const {
  const sockaddr_in place = placeAt(port);
  (void)::sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&place), sizeof place);
}

std::string UdpTalk::receive() const {
  pollfd watched{socket_, POLLIN, 0};
  if (::poll(&watched, 1, kPatience) <= 0) throw std::runtime_error("no datagram came");
  std::array<char, 2048> bytes{};
  const ssize_t got = ::recv(socket_, bytes.data(), bytes.size(), 0);
  return {bytes.data(), got > 0 ? static_cast<std::size_t>(got) : 0};
}

}  // namespace pixelflex::testing
