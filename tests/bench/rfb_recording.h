#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "devices/image/size.h"

namespace pixelflex::testing {

/// What a VNC server said after its ServerInit, in whole messages.
struct RfbRecording {
  devices::Size desktop;
  std::vector<std::uint8_t> messages;
};

/// Connects to the UNIX socket of a server without password, as a viewer that knows Tight at the TigerVNC viewer's own
/// settings (quality 8, compression 2), CopyRect and nothing besides, and asks for updates for `time`. Ends with the
/// server's last whole update. Throws std::runtime_error.
[[nodiscard]] RfbRecording recordServer(const std::string& socketPath, std::chrono::milliseconds time);

}  // namespace pixelflex::testing
