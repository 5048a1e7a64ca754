#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "viewer/vnc/secret.h"

namespace pixelflex::viewer {

/// VNC's own scheme: what to answer to a server's challenge. Only the first eight bytes of the password count.
[[nodiscard]] std::array<std::uint8_t, 16> answerVncChallenge(std::span<const std::uint8_t, 16> challenge,
                                                              std::string_view password);

/// The password in a file that vncpasswd wrote, whose eight bytes are hidden under a key known to all.
[[nodiscard]] Secret revealVncPassword(std::span<const std::uint8_t, 8> hidden);

}  // namespace pixelflex::viewer
