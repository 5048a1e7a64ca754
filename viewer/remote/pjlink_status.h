#pragma once

#include <string>
#include <vector>

#include "viewer/control/wall_snapshot.h"

namespace pixelflex::viewer {

// What PJLink asks of a wall, from its devices.

/// Six digits, the worst of all devices each: fan, lamp, temperature, cover, filter, other; 0 well, 1 a warning, 2 an
/// error. A projector that does not answer is another error, a mirror, or a wall that is only partly on, a warning.
[[nodiscard]] std::string pjlinkErrors(const WallSnapshot& wall, bool partlyOn);

/// "1200 1 1340 0": hours and whether it is lit of each lamp, in the order of the projectors; of more than eight those
/// with the most hours. ERR1 when nobody tells.
[[nodiscard]] std::string pjlinkLamps(const WallSnapshot& wall);

/// The most hours of any filter; ERR1 when nobody tells.
[[nodiscard]] std::string pjlinkFilter(const WallSnapshot& wall);

/// An input of the wall.
struct PjlinkInput {
  std::string code;
  std::string preset;  // empty: the desktop on the wall as it is
};
/// In the order of their codes.
[[nodiscard]] std::vector<PjlinkInput> pjlinkInputs(const WallSnapshot& wall, char itsClass);

/// No longer than so many bytes, no control characters, and no half letters of UTF-8.
[[nodiscard]] std::string pjlinkText(const std::string& text, std::size_t longest);

}  // namespace pixelflex::viewer
