#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

namespace pixelflex::devices {

/// A PJLink device of class 2 that answered a search.
struct PjlinkFound {
  std::string host;      // its IPv4 address
  std::string hardware;  // "00:1b:13:00:00:01"
  bool operator==(const PjlinkFound&) const = default;
};

struct PjlinkSearch {
  /// Where the search goes; empty: to everybody on the networks that this machine is on.
  std::vector<std::string> hosts = {};
  std::uint16_t port = 4352;
  /// Devices may take ten seconds.
  std::chrono::milliseconds patience{11'000};
  std::stop_token stop = {};
};

/// Calls `found` once for each device, as they answer, and returns when patience ends. Throws DeviceError when this
/// machine cannot send at all.
void searchPjlink(const PjlinkSearch& search, const std::function<void(const PjlinkFound& device)>& found);

}  // namespace pixelflex::devices
