#include "devices/projector_control/beef_link.h"

#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "devices/projector_control/pjlink_login.h"

namespace pixelflex::devices {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kTimeout{1000};
// A projector that asks for a password greets with random digits at once; others say nothing.
constexpr milliseconds kGreetingTimeout{1000};
constexpr std::size_t kGreeting = 8;

/// Acknowledged, not understood; refused, data, busy.
std::size_t lengthOfReply(char first) {
  if (first == '\x06' || first == '\x15') return 1;
  return first == '\x1C' || first == '\x1D' || first == '\x1F' ? 3 : 0;
}

/// Where a reply is in what was received; with a number, the one that carries it. Other bytes are left out.
std::optional<std::pair<std::size_t, std::size_t>> findReply(std::string_view received, std::optional<char> number) {
  for (std::size_t i = 0; i < received.size(); ++i) {
    const std::size_t length = lengthOfReply(received[i]);
    if (length == 0) continue;
    if (i + length + (number ? 1 : 0) > received.size()) return std::nullopt;
    if (!number || received[i + length] == *number) return std::pair(i, length);
    i += length;
  }
  return std::nullopt;
}

}  // namespace

std::string wrappedBeefFrame(const std::string& frame, std::uint8_t number) {
  std::string bytes = std::string("\x02\x0D") + frame;
  const auto sum = std::accumulate(bytes.begin(), bytes.end(), 0U,
                                   [](unsigned total, char byte) { return total + static_cast<unsigned char>(byte); });
  bytes += static_cast<char>((256U - sum % 256U) % 256U);
  bytes += static_cast<char>(number);
  return bytes;
}

BeefLink::BeefLink(Line& line, std::string password)
    : line_(line),
      wrapped_(line.address().kind == LineKind::kTcp && line.address().port == kNetworkPort),
      password_(std::move(password)) {}

std::string BeefLink::ask(const std::string& frame, bool mayRepeat) {
  try {
    return tryAsk(frame);
  } catch (const LineError& error) {
    session_ = 0;  // the digest may be lost with what it stood before
    const bool mayHeal = error.failure() == LineFailure::kSilent || error.failure() == LineFailure::kLost;
    if (!mayHeal || !mayRepeat) throw;
  }
  return tryAsk(frame);
}

std::string BeefLink::tryAsk(const std::string& frame) {
  const std::optional<char> number = wrapped_ ? std::optional(static_cast<char>(++number_)) : std::nullopt;
  std::string bytes = frame;
  if (wrapped_) {
    const std::string digest = login();
    bytes = digest + wrappedBeefFrame(frame, number_);
  }
  const auto end = [number](std::string_view received) -> std::optional<std::size_t> {
    const auto found = findReply(received, number);
    return found ? std::optional(found->first + found->second + (number ? 1 : 0)) : std::nullopt;
  };
  const std::string received = line_.ask({.bytes = bytes, .end = end, .timeout = kTimeout});
  // A connection that was made in between has not been logged in to.
  if (session_ != line_.session()) session_ = 0;
  const auto found = findReply(received, number);
  const std::string reply = received.substr(found->first, found->second);
  if (reply.starts_with("\x1F\x04")) session_ = 0;
  return reply;
}

/// What goes before the first command of a connection.
std::string BeefLink::login() {
  if (password_.empty() || (session_ != 0 && session_ == line_.session() && line_.isConnected())) return {};
  line_.disconnect();
  session_ = 0;
  const auto whole = [](std::string_view received) {
    return received.size() >= kGreeting ? std::optional(kGreeting) : std::nullopt;
  };
  std::string greeting;
  try {
    greeting = line_.ask({.bytes = "", .end = whole, .timeout = kGreetingTimeout, .keepEarlier = true});
  } catch (const LineError& error) {
    if (error.failure() != LineFailure::kSilent) throw;
  }
  session_ = line_.session();
  return greeting.empty() ? "" : pjlinkMd5(greeting, password_);
}

}  // namespace pixelflex::devices
