#pragma once

#include <cstdint>

namespace pixelflex::viewer {

// X11 keysyms, as in X11/keysymdef.h.
inline constexpr std::uint32_t kControlLeft = 0xFFE3;
inline constexpr std::uint32_t kControlRight = 0xFFE4;
inline constexpr std::uint32_t kMetaLeft = 0xFFE7;
inline constexpr std::uint32_t kAltLeft = 0xFFE9;
inline constexpr std::uint32_t kAltRight = 0xFFEA;

[[nodiscard]] constexpr bool isControl(std::uint32_t keysym) {
  return keysym == kControlLeft || keysym == kControlRight;
}

/// With Shift, Alt is Meta in most layouts.
[[nodiscard]] constexpr bool isAlt(std::uint32_t keysym) {
  return keysym == kAltLeft || keysym == kAltRight || keysym == kMetaLeft || keysym == kMetaLeft + 1;
}

}  // namespace pixelflex::viewer
