#include "viewer/vnc/rfb_messages.h"

#include <bit>

namespace pixelflex::viewer {
namespace {

static_assert(std::endian::native == std::endian::little, "the pixel format below is asked for as little-endian");

constexpr std::int32_t kQuality0 = -32;
constexpr std::int32_t kCompressLevel0 = -256;

}  // namespace

std::uint32_t bigEndian(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

void appendNumber(std::vector<std::uint8_t>& message, std::uint32_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
    message.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

namespace {

void appendTwo(std::vector<std::uint8_t>& message, int first, int second) {
  appendNumber(message, static_cast<std::uint32_t>(first), 2);
  appendNumber(message, static_cast<std::uint32_t>(second), 2);
}

}  // namespace

std::vector<std::uint8_t> setPixelFormatMessage() {
  return {0,  0,   0,  0,            // type, padding
          32, 24,  0,  1,            // bits, depth, little-endian, true colour
          0,  255, 0,  255, 0, 255,  // largest red, green, blue
          0,  8,   16, 0,   0, 0};   // shifts of red, green, blue; padding
}

std::vector<std::uint8_t> setEncodingsMessage(const EncodingWishes& wishes) {
  // Raw comes last: libvncserver sends it in whole rows that overrun its buffer beyond 8192 pixels. Nothing else that
  // libvncclient decodes: each decoder is one more door for a hostile server.
  std::vector<std::int32_t> encodings{kTightEncoding,
                                      kCopyRectEncoding,
                                      kZrleEncoding,
                                      kRawEncoding,
                                      kCompressLevel0 + wishes.link.compression,
                                      kLastRectEncoding,
                                      kDesktopSizeEncoding,
                                      kCursorWithAlphaEncoding,
                                      kRichCursorEncoding,
                                      kXCursorEncoding,
                                      kPointerPosEncoding,
                                      kVmwareCursorPositionEncoding,
                                      kFenceEncoding,
                                      kContinuousUpdatesEncoding,
                                      kExtendedMouseButtonsEncoding};
  if (wishes.mayResize) encodings.push_back(kExtendedDesktopSizeEncoding);
  if (wishes.clipboard) encodings.push_back(kExtendedClipboardEncoding);
  if (wishes.link.quality) encodings.push_back(kQuality0 + *wishes.link.quality);
  std::vector<std::uint8_t> message{2, 0};  // type, padding
  appendNumber(message, static_cast<std::uint32_t>(encodings.size()), 2);
  for (const std::int32_t encoding : encodings) appendNumber(message, static_cast<std::uint32_t>(encoding), 4);
  return message;
}

std::vector<std::uint8_t> updateRequestMessage(bool incremental, devices::Size size) {
  std::vector<std::uint8_t> message{3, static_cast<std::uint8_t>(incremental ? 1 : 0), 0, 0, 0, 0};
  appendTwo(message, size.width, size.height);
  return message;
}

std::vector<std::uint8_t> continuousUpdatesMessage(devices::Size size) {
  std::vector<std::uint8_t> message{150, 1, 0, 0, 0, 0};
  appendTwo(message, size.width, size.height);
  return message;
}

std::vector<std::uint8_t> fenceMessage(std::uint32_t flags, std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> message{248, 0, 0, 0};
  appendNumber(message, flags, 4);
  appendNumber(message, static_cast<std::uint32_t>(payload.size()), 1);
  message.insert(message.end(), payload.begin(), payload.end());
  return message;
}

std::vector<std::uint8_t> pointerMessage(int x, int y, std::uint16_t buttons, bool extended) {
  constexpr unsigned kPlainButtons = 0x7f;
  constexpr unsigned kMore = 0x80;  // a byte with the others follows
  const unsigned others = extended ? buttons >> 7 & 0xffu : 0;
  std::vector<std::uint8_t> message{5};
  appendNumber(message, (buttons & (extended ? kPlainButtons : 0xffu)) | (others != 0 ? kMore : 0), 1);
  appendTwo(message, x, y);
  if (others != 0) appendNumber(message, others, 1);
  return message;
}

std::vector<std::uint8_t> keyMessage(std::uint32_t keysym, bool down) {
  std::vector<std::uint8_t> message{4, static_cast<std::uint8_t>(down ? 1 : 0), 0, 0};
  appendNumber(message, keysym, 4);
  return message;
}

std::vector<std::uint8_t> clipboardMessage(std::string_view latin1) {
  std::vector<std::uint8_t> message{6, 0, 0, 0};
  appendNumber(message, static_cast<std::uint32_t>(latin1.size()), 4);
  message.insert(message.end(), latin1.begin(), latin1.end());
  return message;
}

}  // namespace pixelflex::viewer
