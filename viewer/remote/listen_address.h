#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pixelflex::viewer {

/// Where a server of ours listens.
struct ListenAddress {
  std::string host = "127.0.0.1";  // a numeric address, without brackets
  std::uint16_t port = 0;          // 0: a free one

  /// Nobody but this machine reaches it.
  [[nodiscard]] bool isLoopback() const;
  /// "127.0.0.1:8080", "[::1]:8080"
  [[nodiscard]] std::string text() const;
  bool operator==(const ListenAddress&) const = default;
};

/// Reads `PORT` (on this machine only), `ADDRESS:PORT` and `[V6]:PORT`; an address is numeric or `localhost`. Throws
/// std::invalid_argument, whose message quotes the text and says how to write it.
[[nodiscard]] ListenAddress parseListenAddress(std::string_view text);

}  // namespace pixelflex::viewer
