#include "viewer/vnc/link_watch.h"

#include <arpa/inet.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <iomanip>
#include <sstream>

namespace pixelflex::viewer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPingPeriod{3};

bool isLoopback(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(address);
    return ntohl(v4.sin_addr.s_addr) >> 24 == IN_LOOPBACKNET;
  }
  const auto& v6 = reinterpret_cast<const sockaddr_in6&>(address);
  return IN6_IS_ADDR_LOOPBACK(&v6.sin6_addr) != 0;
}

bool isNetwork(int socket, bool loopbackIsLocal) {
  sockaddr_storage address{};
  socklen_t length = sizeof address;
  if (::getpeername(socket, reinterpret_cast<sockaddr*>(&address), &length) != 0) return false;
  if (address.ss_family != AF_INET && address.ss_family != AF_INET6) return false;
  return !loopbackIsLocal || !isLoopback(address);
}

tcp_info infoOf(int socket) {
  tcp_info info{};
  socklen_t length = sizeof info;
  ::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &length);
  return info;
}

}  // namespace

LinkWatch::LinkWatch(int socket, const SessionOptions& options) : socket_(socket), options_(options) {
  if (options.link != Link::kAuto) {
    fixed_ = settingsFor(options.link);
  } else if (isNetwork(socket, options.loopbackIsLocal)) {
    tuner_.emplace(std::chrono::microseconds(infoOf(socket).tcpi_rtt));
  }
}

LinkSettings LinkWatch::settings() const {
  return settingsOf(tuner_ ? tuner_->settings() : fixed_);
}

LinkSettings LinkWatch::settingsOf(LinkSettings settings) const {
  if (options_.lossless) settings.quality.reset();
  return settings;
}

void LinkWatch::before() {
  if (tuner_) bytesBefore_ = infoOf(socket_).tcpi_bytes_received;
}

std::optional<std::string> LinkWatch::after(RfbClient& client, std::chrono::nanoseconds waiting) {
  if (!tuner_) return std::nullopt;
  const auto now = Clock::now();
  if (now - pinged_ >= kPingPeriod && client.ping()) pinged_ = now;
  tuner_->setRoundTrip(roundTrip(client));
  const LinkSettings had = settings();
  if (!tuner_->received(infoOf(socket_).tcpi_bytes_received - bytesBefore_, waiting, now)) return std::nullopt;
  if (settings() == had) return std::nullopt;
  client.setLink(settings());
  return describe(client);
}

// Through a tunnel only the server's own answers tell; those that come late may have waited behind pixels.
std::chrono::nanoseconds LinkWatch::roundTrip(const RfbClient& client) const {
  if (const auto time = client.roundTrip()) return *time;
  return std::chrono::microseconds(infoOf(socket_).tcpi_min_rtt);
}

std::string LinkWatch::describe(const RfbClient& client) const {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "the connection carries " << tuner_->rate() / 1e6 << " Mbit/s, "
       << std::chrono::duration<double, std::milli>(roundTrip(client)).count() << " ms there and back: ";
  if (settings().quality) text << "JPEG quality " << *settings().quality << ", ";
  text << "compression " << settings().compression;
  return text.str();
}

}  // namespace pixelflex::viewer
