#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace pixelflex::viewer {

/// Pseudo-encodings that libvncclient does not know; rfb_client.cpp handles them.
inline constexpr std::int32_t kCursorWithAlphaEncoding = -314;
inline constexpr std::int32_t kVmwareCursorPositionEncoding = 0x574d5666;

/// Client to server: 32 bits a pixel with red, green, blue in bytes 0, 1, 2 of memory, as textures want them.
[[nodiscard]] std::vector<std::uint8_t> setPixelFormatMessage();

/// Client to server: the encodings, best first. Lossless keeps the server from JPEG.
[[nodiscard]] std::vector<std::uint8_t> setEncodingsMessage(bool lossless);

/// An unsigned number of at most four bytes in network order.
[[nodiscard]] std::uint32_t bigEndian(std::span<const std::uint8_t> bytes);
void appendNumber(std::vector<std::uint8_t>& message, std::uint32_t value, int bytes);

}  // namespace pixelflex::viewer
