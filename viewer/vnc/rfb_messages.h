#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "devices/image/size.h"
#include "viewer/vnc/link.h"

namespace pixelflex::viewer {

/// The encodings that are asked for, and no others.
inline constexpr std::int32_t kRawEncoding = 0;
inline constexpr std::int32_t kCopyRectEncoding = 1;
inline constexpr std::int32_t kTightEncoding = 7;
inline constexpr std::int32_t kZrleEncoding = 16;
/// Those that carry no pixels.
inline constexpr std::int32_t kDesktopSizeEncoding = -223;
inline constexpr std::int32_t kLastRectEncoding = -224;
inline constexpr std::int32_t kPointerPosEncoding = -232;
inline constexpr std::int32_t kRichCursorEncoding = -239;
inline constexpr std::int32_t kXCursorEncoding = -240;
inline constexpr std::int32_t kExtendedDesktopSizeEncoding = -308;
inline constexpr std::int32_t kFenceEncoding = -312;
inline constexpr std::int32_t kContinuousUpdatesEncoding = -313;
inline constexpr std::int32_t kCursorWithAlphaEncoding = -314;
inline constexpr std::int32_t kExtendedMouseButtonsEncoding = -316;
inline constexpr std::int32_t kExtendedClipboardEncoding = static_cast<std::int32_t>(0xc0a1e5ce);
inline constexpr std::int32_t kVmwareCursorPositionEncoding = 0x574d5666;

/// Client to server: 32 bits a pixel with red, green, blue in bytes 0, 1, 2 of memory, as textures want them.
[[nodiscard]] std::vector<std::uint8_t> setPixelFormatMessage();

struct EncodingWishes {
  LinkSettings link;
  bool mayResize = false;  // it tells of its screens, without which it takes no wishes for them
  bool clipboard = false;  // the extended one
};

/// Client to server: the encodings, best first.
[[nodiscard]] std::vector<std::uint8_t> setEncodingsMessage(const EncodingWishes& wishes);

/// Client to server: the upper left part of the desktop, of this size; what has changed there, or everything.
[[nodiscard]] std::vector<std::uint8_t> updateRequestMessage(bool incremental, devices::Size size);

/// Client to server: updates of that part may come unasked from now on.
[[nodiscard]] std::vector<std::uint8_t> continuousUpdatesMessage(devices::Size size);

/// Client to server: the answer to a fence, with the server's own payload.
[[nodiscard]] std::vector<std::uint8_t> fenceMessage(std::uint32_t flags, std::span<const std::uint8_t> payload);

/// Client to server: input. The position is in desktop pixels, the keysym is X11's, the text Latin-1.
/// Buttons beyond the seventh need a server that said that it takes them.
[[nodiscard]] std::vector<std::uint8_t> pointerMessage(int x, int y, std::uint16_t buttons, bool extended);
[[nodiscard]] std::vector<std::uint8_t> keyMessage(std::uint32_t keysym, bool down);
[[nodiscard]] std::vector<std::uint8_t> clipboardMessage(std::string_view latin1);

/// An unsigned number of at most four bytes in network order.
[[nodiscard]] std::uint32_t bigEndian(std::span<const std::uint8_t> bytes);
void appendNumber(std::vector<std::uint8_t>& message, std::uint32_t value, int bytes);

}  // namespace pixelflex::viewer
