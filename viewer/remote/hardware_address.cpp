#include <ifaddrs.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <memory>

#include "viewer/remote/pjlink_notices.h"

namespace pixelflex::viewer {
namespace {

using Bytes = std::array<unsigned char, 6>;

std::string textOf(const Bytes& bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += (text.empty() ? "" : ":") + std::string{kDigits[byte >> 4U], kDigits[byte & 15U]};
  }
  return text;
}

bool hasHardware(const ifaddrs& interface) {
  if (interface.ifa_addr == nullptr || interface.ifa_addr->sa_family != AF_PACKET) return false;
  return (interface.ifa_flags & IFF_LOOPBACK) == 0U && (interface.ifa_flags & IFF_UP) != 0U;
}

/// Locally administered, so that no manufacturer's address is the same.
Bytes madeUp() {
  std::array<char, 256> name{};
  (void)::gethostname(name.data(), name.size() - 1);
  const std::size_t hash = std::hash<std::string_view>()(name.data());
  Bytes bytes{0x02};
  std::memcpy(bytes.data() + 1, &hash, bytes.size() - 1);
  return bytes;
}

}  // namespace

std::string hardwareAddress() {
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return textOf(madeUp());
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> all(first, ::freeifaddrs);
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    if (!hasHardware(*each)) continue;
    sockaddr_ll link{};
    std::memcpy(&link, each->ifa_addr, sizeof link);
    Bytes bytes{};
    if (link.sll_hatype != ARPHRD_ETHER || link.sll_halen != bytes.size()) continue;
    std::copy_n(std::begin(link.sll_addr), bytes.size(), bytes.begin());
    return textOf(bytes);
  }
  return textOf(madeUp());
}

}  // namespace pixelflex::viewer
