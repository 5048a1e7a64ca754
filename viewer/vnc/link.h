#pragma once

#include <optional>

namespace pixelflex::viewer {

/// What lies between the server and this machine.
enum class Link {
  kAuto,   // measured, and followed when it changes
  kLocal,  // the same machine
  kLan,
  kWifi,
  kWan,
};

/// How a server is asked to compress.
struct LinkSettings {
  /// Of JPEG, 0 to 9 as Tight has it: which of them halve the resolution of colours is the server's choice (TigerVNC's
  /// do below 6). Empty: no JPEG, every pixel arrives as it is.
  std::optional<int> quality;
  /// Of zlib, 0 to 9; from 2 on TigerVNC also looks for pixels that did not change.
  int compression = 1;
  bool operator==(const LinkSettings&) const = default;
};

/// For kAuto those to begin with.
[[nodiscard]] LinkSettings settingsFor(Link link);

}  // namespace pixelflex::viewer
