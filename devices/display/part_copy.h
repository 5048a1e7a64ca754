#pragma once

namespace pixelflex::devices {

/// Whether parts of the window whose context is current may be brought from its back buffer to the screen one by one,
/// and had better be: where the driver draws on the processor, a swap sends the whole window to the X server as pixels.
[[nodiscard]] bool copiesParts();

/// Brings a part of the current window's back buffer to the screen. Window pixels, y from below. Needs copiesParts().
void copyPart(int left, int bottom, int width, int height);

}  // namespace pixelflex::devices
