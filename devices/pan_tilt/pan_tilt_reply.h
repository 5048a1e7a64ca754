#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pixelflex::devices {

/// What a Directed Perception unit said, whether it echoes or not, verbose or terse, ending lines in CR, LF or both.
struct PanTiltReply {
  bool success = false;  // "*", else "! …"
  std::string text;      // what follows
  int panStops = 0;      // "!P" heard meanwhile: the axis ran into its limit
  int tiltStops = 0;
};

/// How many bytes of `received` make a reply (see ReplyEnd).
[[nodiscard]] std::optional<std::size_t> endOfPanTiltReply(std::string_view received);

/// Of bytes that endOfPanTiltReply() found whole.
[[nodiscard]] PanTiltReply parsePanTiltReply(std::string_view bytes);

/// The number in a reply's text: "-500" of "Current Pan position is -500", "2000" of "Pan acceleration is 2000
/// positions/sec^2".
[[nodiscard]] std::optional<double> numberInReply(std::string_view text);

}  // namespace pixelflex::devices
