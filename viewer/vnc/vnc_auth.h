#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace pixelflex::viewer {

/// VNC's own scheme: what to answer to a server's challenge. Only the first eight bytes of the password count.
[[nodiscard]] std::array<std::uint8_t, 16> answerVncChallenge(std::span<const std::uint8_t, 16> challenge,
                                                              const std::string& password);

/// The password in a file that vncpasswd wrote, whose eight bytes are hidden under a key known to all.
[[nodiscard]] std::string revealVncPassword(std::span<const std::uint8_t, 8> hidden);

/// Overwrites a secret that is no longer needed, and empties it.
void wipe(std::string& secret);

}  // namespace pixelflex::viewer
