#include "devices/projector_control/pjlink_search.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string_view>

#include "devices/control/device_error.h"

namespace pixelflex::devices {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view kQuestion = "%2SRCH\r";
constexpr std::string_view kAnswer = "%2ACKN=";
constexpr std::size_t kHardware = 17;  // letters
constexpr std::size_t kMostFound = 1000;
constexpr std::chrono::milliseconds kPoll{100};

class SearchSocket {
 public:
  explicit SearchSocket(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const int yes = 1;
    if (socket_ < 0 || ::setsockopt(socket_, SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes) != 0) {
      throw DeviceError("PJLink: this machine gives no socket to search with");
    }
    // Some devices answer to the port of their own rather than to the sender's; where somebody has it, to the others.
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    (void)::bind(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof place);
  }
  ~SearchSocket() { ::close(socket_); }
  SearchSocket(const SearchSocket&) = delete;
  SearchSocket& operator=(const SearchSocket&) = delete;

  [[nodiscard]] bool ask(in_addr host, std::uint16_t port) const {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    place.sin_addr = host;
    return ::sendto(socket_, kQuestion.data(), kQuestion.size(), 0, reinterpret_cast<const sockaddr*>(&place),
                    sizeof place) == static_cast<ssize_t>(kQuestion.size());
  }

  /// What comes next; nothing came within a moment: an empty text.
  [[nodiscard]] std::string hear(in_addr& from) const {
    pollfd watched{socket_, POLLIN, 0};
    if (::poll(&watched, 1, static_cast<int>(kPoll.count())) <= 0) return {};
    std::array<char, 256> bytes{};
    sockaddr_in sender{};
    socklen_t size = sizeof sender;
    const ssize_t got = ::recvfrom(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&sender), &size);
    from = sender.sin_addr;
    return {bytes.data(), got > 0 ? static_cast<std::size_t>(got) : 0};
  }

 private:
  int socket_;
};

/// Of each network that this machine is on.
std::vector<in_addr> broadcasts() {
  std::vector<in_addr> places;
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return places;
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> all(first, ::freeifaddrs);
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    const bool fits = each->ifa_addr != nullptr && each->ifa_addr->sa_family == AF_INET &&
                      (each->ifa_flags & IFF_BROADCAST) != 0U && each->ifa_broadaddr != nullptr;
    if (!fits) continue;
    sockaddr_in place{};
    std::memcpy(&place, each->ifa_broadaddr, sizeof place);
    places.push_back(place.sin_addr);
  }
  return places;
}

std::vector<in_addr> placesOf(const PjlinkSearch& search) {
  if (search.hosts.empty()) return broadcasts();
  std::vector<in_addr> places;
  for (const auto& host : search.hosts) {
    in_addr place{};
    if (::inet_pton(AF_INET, host.c_str(), &place) != 1)
      throw DeviceError("PJLink: \"" + host + "\" is no IPv4 address");
    places.push_back(place);
  }
  return places;
}

std::string textOf(in_addr host) {
  std::array<char, INET_ADDRSTRLEN> text{};
  return ::inet_ntop(AF_INET, &host, text.data(), text.size()) == nullptr ? "" : text.data();
}

/// The address in an answer; empty for any other datagram.
std::string hardwareIn(std::string_view text) {
  if (!text.starts_with(kAnswer) || !text.ends_with('\r')) return {};
  text = text.substr(kAnswer.size(), text.size() - kAnswer.size() - 1);
  const auto fits = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F') || c == ':';
  };
  return text.size() == kHardware && std::ranges::all_of(text, fits) ? std::string(text) : std::string();
}

}  // namespace

void searchPjlink(const PjlinkSearch& search, const std::function<void(const PjlinkFound& device)>& found) {
  const SearchSocket socket(search.port);
  const auto places = placesOf(search);
  const auto sent = std::ranges::count_if(places, [&](in_addr place) { return socket.ask(place, search.port); });
  if (sent == 0) throw DeviceError("PJLink: this machine is on no network that can be searched");
  const auto deadline = Clock::now() + search.patience;
  std::vector<PjlinkFound> known;
  while (Clock::now() < deadline && !search.stop.stop_requested() && known.size() < kMostFound) {
    in_addr from{};
    PjlinkFound device{.host = {}, .hardware = hardwareIn(socket.hear(from))};
    device.host = textOf(from);
    if (device.hardware.empty() || std::ranges::find(known, device) != known.end()) continue;
    known.push_back(device);
    found(device);
  }
}

}  // namespace pixelflex::devices
