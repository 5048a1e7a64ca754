#include "viewer/remote/listen_address.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <charconv>
#include <stdexcept>

namespace pixelflex::viewer {
namespace {

[[noreturn]] void refuse(std::string_view text) {
  throw std::invalid_argument("\"" + std::string(text.substr(0, 80)) +
                              "\" is no place to listen at: write PORT for this machine only, or an address of this "
                              "machine and a port, such as 0.0.0.0:8080 or [::]:8080");
}

bool isV6(const std::string& host) {
  in6_addr address{};
  return ::inet_pton(AF_INET6, host.c_str(), &address) == 1;
}

bool isV4(const std::string& host) {
  in_addr address{};
  return ::inet_pton(AF_INET, host.c_str(), &address) == 1;
}

}  // namespace

bool ListenAddress::isLoopback() const {
  in6_addr address{};
  if (::inet_pton(AF_INET6, host.c_str(), &address) == 1) return IN6_IS_ADDR_LOOPBACK(&address) != 0;
  return isV4(host) && host.starts_with("127.");
}

std::string ListenAddress::text() const {
  return (isV6(host) ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

ListenAddress parseListenAddress(std::string_view text) {
  ListenAddress address;
  std::string_view digits = text;
  if (const auto colon = text.rfind(':'); colon != std::string_view::npos) {
    std::string_view host = text.substr(0, colon);
    digits = text.substr(colon + 1);
    const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
    if (bracketed) host = host.substr(1, host.size() - 2);
    address.host = host == "localhost" ? "127.0.0.1" : std::string(host);
    if (bracketed ? !isV6(address.host) : !isV4(address.host)) refuse(text);
  }
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), address.port);
  if (error != std::errc() || end != digits.data() + digits.size() || digits.empty()) refuse(text);
  return address;
}

}  // namespace pixelflex::viewer
