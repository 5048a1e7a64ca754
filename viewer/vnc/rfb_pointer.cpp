#include "viewer/vnc/rfb_pointer.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "viewer/vnc/event_queue.h"
#include "viewer/vnc/rfb_cursor.h"
#include "viewer/vnc/rfb_messages.h"

namespace pixelflex::viewer {
namespace {

constexpr int kMaxExtent = 1024;

void requireReadable(const RfbState& rfb, devices::Size size) {
  if (size.width <= kMaxExtent && size.height <= kMaxExtent) return;
  rfb.refuse("sent a pointer shape of " + std::to_string(size.width) + "x" + std::to_string(size.height) + " pixels");
}

void post(RfbState& rfb, CursorShape shape, int hotX, int hotY) {
  shape.hotX = hotX;
  shape.hotY = hotY;
  appendEvent(rfb.events, std::move(shape));
}

std::vector<std::uint8_t> readBytes(const RfbState& rfb, std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  rfb.read(bytes);
  return bytes;
}

// One byte a pixel, out of rows of bits that begin on a byte each.
std::vector<std::uint8_t> readBits(const RfbState& rfb, devices::Size size) {
  const auto width = static_cast<std::size_t>(size.width);
  const auto height = static_cast<std::size_t>(size.height);
  const std::size_t row = (width + 7) / 8;
  const std::vector<std::uint8_t> packed = readBytes(rfb, row * height);
  std::vector<std::uint8_t> bits;
  bits.reserve(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) bits.push_back(packed[y * row + x / 8] >> (7 - x % 8) & 1);
  }
  return bits;
}

}  // namespace

void readRichCursor(RfbState& rfb, devices::Size size, int hotX, int hotY) {
  requireReadable(rfb, size);
  const std::vector<std::uint8_t> colours = readBytes(rfb, 4 * static_cast<std::size_t>(size.area()));
  post(rfb, cursorFromMask(size, colours, readBits(rfb, size)), hotX, hotY);
}

void readXCursor(RfbState& rfb, devices::Size size, int hotX, int hotY) {
  requireReadable(rfb, size);
  if (size.area() == 0) return post(rfb, {.size = size, .rgba = {}}, hotX, hotY);
  const std::vector<std::uint8_t> inks = readBytes(rfb, 6);  // foreground, background
  std::vector<std::uint8_t> colours;
  for (const std::uint8_t ink : readBits(rfb, size)) {
    for (std::size_t channel = 0; channel < 3; ++channel) colours.push_back(inks[(ink != 0 ? 0 : 3) + channel]);
    colours.push_back(0);
  }
  post(rfb, cursorFromMask(size, colours, readBits(rfb, size)), hotX, hotY);
}

void readAlphaCursor(RfbState& rfb, devices::Size size, int hotX, int hotY) {
  std::array<std::uint8_t, 4> encoding{};
  rfb.read(encoding);
  if (bigEndian(encoding) != 0) rfb.refuse("sent a pointer shape that cannot be read");
  requireReadable(rfb, size);
  CursorShape shape = cursorFromPremultiplied(size, readBytes(rfb, 4 * static_cast<std::size_t>(size.area())));
  rfb.pointerDrawn = size.area() == 0;  // or the pointer is hidden, which looks the same
  post(rfb, std::move(shape), hotX, hotY);
}

}  // namespace pixelflex::viewer
