#include "viewer/vnc/rfb_cursor.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace pixelflex::viewer {

CursorShape cursorFromMask(devices::Size size, std::span<const std::uint8_t> colours,
                           std::span<const std::uint8_t> mask) {
  assert(colours.size() == 4 * mask.size());
  CursorShape shape{size, 0, 0, {colours.begin(), colours.end()}};
  for (std::size_t i = 0; i < mask.size(); ++i) shape.rgba[4 * i + 3] = mask[i] != 0 ? 255 : 0;
  return shape;
}

CursorShape cursorFromPremultiplied(devices::Size size, std::span<const std::uint8_t> rgba) {
  CursorShape shape{size, 0, 0, {rgba.begin(), rgba.end()}};
  for (std::size_t i = 0; i + 3 < shape.rgba.size(); i += 4) {
    const unsigned alpha = shape.rgba[i + 3];
    for (std::size_t channel = i; alpha != 0 && channel < i + 3; ++channel) {
      shape.rgba[channel] = static_cast<std::uint8_t>(std::min(255u, (shape.rgba[channel] * 255u + alpha / 2) / alpha));
    }
  }
  return shape;
}

}  // namespace pixelflex::viewer
