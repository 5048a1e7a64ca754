#include "viewer/vnc/server_address.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace pixelflex::viewer {
namespace {

constexpr int kMaxPort = 65535;
constexpr std::string_view kUnixPrefix = "unix:";
constexpr std::string_view kXPrefix = "x11:";

[[noreturn]] void refuse(std::string_view text, const std::string& why) {
  throw std::invalid_argument("server address \"" + std::string(text) + "\": " + why +
                              " (write HOST:DISPLAY, HOST::PORT, [IPV6]::PORT, unix:PATH or x11:DISPLAY)");
}

int parseNumber(std::string_view digits, std::string_view text, const std::string& what) {
  int number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size() || number < 0) {
    refuse(text, "the " + what + " must be a number");
  }
  return number;
}

int parseDisplay(std::string_view digits, std::string_view text) {
  const int display = parseNumber(digits, text, "display");
  if (display >= kFirstPort) {
    refuse(text, "there is no display " + std::string(digits) + "; a port takes two colons: ::" + std::string(digits));
  }
  return kFirstPort + display;
}

int parsePort(std::string_view digits, std::string_view text) {
  const int port = parseNumber(digits, text, "port");
  if (port < 1 || port > kMaxPort) refuse(text, "a port is a number from 1 to 65535");
  return port;
}

// What follows the host: nothing, ":DISPLAY" or "::PORT".
int parseSuffix(std::string_view suffix, std::string_view text) {
  if (suffix.empty()) return kFirstPort;
  if (suffix.starts_with("::")) return parsePort(suffix.substr(2), text);
  if (suffix.starts_with(":")) return parseDisplay(suffix.substr(1), text);
  refuse(text, "after the closing bracket comes :DISPLAY or ::PORT");
}

bool isBlankOrControl(char c) {
  return static_cast<unsigned char>(c) <= ' ' || c == '\x7f';
}

struct HostAndSuffix {
  std::string_view host;
  std::string_view suffix;
};

HostAndSuffix splitHost(std::string_view text) {
  if (text.starts_with('[')) {
    const std::size_t close = text.find(']');
    if (close == std::string_view::npos) refuse(text, "the closing bracket is missing");
    return {text.substr(1, close - 1), text.substr(close + 1)};
  }
  const std::size_t colon = std::min(text.find(':'), text.size());
  const HostAndSuffix parts{text.substr(0, colon), text.substr(colon)};
  const std::size_t digits = parts.suffix.find_first_not_of(':');
  if (digits != std::string_view::npos && parts.suffix.find(':', digits) != std::string_view::npos) {
    refuse(text, "an IPv6 address needs brackets around it");
  }
  return parts;
}

}  // namespace

ServerAddress parseServerAddress(std::string_view text) {
  if (text.starts_with(kUnixPrefix)) {
    const std::string_view path = text.substr(kUnixPrefix.size());
    if (path.empty()) refuse(text, "the path of the socket is missing");
    return {{}, kFirstPort, std::string(path), {}};
  }
  if (text.starts_with(kXPrefix)) {
    const std::string_view display = text.substr(kXPrefix.size());
    if (display.empty()) refuse(text, "the display is missing, as in x11::7");
    return {{}, kFirstPort, {}, std::string(display)};
  }
  const auto [host, suffix] = splitHost(text);
  if (host.empty()) refuse(text, "the host is missing");
  if (std::any_of(host.begin(), host.end(), isBlankOrControl)) refuse(text, "a host's name has no blanks");
  return {std::string(host), parseSuffix(suffix, text), {}, {}};
}

std::string ServerAddress::text() const {
  if (isXDisplay()) return std::string(kXPrefix) + xDisplay;
  if (isUnixSocket()) return std::string(kUnixPrefix) + socketPath;
  const std::string bracketed = host.find(':') == std::string::npos ? host : "[" + host + "]";
  const int display = port - kFirstPort;
  const bool usual = display >= 0 && display < 100;
  return usual ? bracketed + ":" + std::to_string(display) : bracketed + "::" + std::to_string(port);
}

}  // namespace pixelflex::viewer
