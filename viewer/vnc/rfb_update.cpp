#include "viewer/vnc/rfb_update.h"

#include <rfb/rfbclient.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "viewer/vnc/event_queue.h"
#include "viewer/vnc/rfb_messages.h"
#include "viewer/vnc/rfb_pointer.h"
#include "viewer/vnc/rfb_resize.h"

namespace pixelflex::viewer {
namespace {

struct Rectangle {
  int x = 0, y = 0;
  devices::Size size;
  std::int32_t encoding = 0;
  std::array<std::uint8_t, 12> bytes{};  // as the server sent it
};

Rectangle readRectangle(RfbState& rfb) {
  Rectangle rect;
  rfb.read(rect.bytes);
  const std::span<const std::uint8_t> bytes(rect.bytes);
  const auto u16 = [&bytes](std::size_t at) { return static_cast<int>(bigEndian(bytes.subspan(at, 2))); };
  rect.x = u16(0);
  rect.y = u16(2);
  rect.size = {u16(4), u16(6)};
  rect.encoding = static_cast<std::int32_t>(bigEndian(bytes.subspan(8)));
  return rect;
}

Box boxAt(int x, int y, devices::Size size) {
  return {x, y, x + size.width, y + size.height};
}

void requireInside(const RfbState& rfb, const Rectangle& rect, int x, int y, const char* what) {
  const bool inside = x + rect.size.width <= rfb.pixelsSize.width && y + rect.size.height <= rfb.pixelsSize.height;
  if (inside) return;
  rfb.refuse(std::string("sent a rectangle ") + what + " outside its desktop: " + std::to_string(rect.size.width) +
             "x" + std::to_string(rect.size.height) + " at " + std::to_string(x) + ", " + std::to_string(y));
}

std::uint8_t* pixelAt(const RfbState& rfb, int x, int y) {
  return rfb.pixels.get() +
         std::size_t{4} * (static_cast<std::size_t>(y) * static_cast<std::size_t>(rfb.pixelsSize.width) +
                           static_cast<std::size_t>(x));
}

void readRaw(RfbState& rfb, const Rectangle& rect) {
  const std::size_t row = std::size_t{4} * static_cast<std::size_t>(rect.size.width);
  for (int y = rect.y; y < rect.y + rect.size.height; ++y) rfb.read({pixelAt(rfb, rect.x, y), row});
}

void copyRect(RfbState& rfb, const Rectangle& rect) {
  std::array<std::uint8_t, 4> source{};
  rfb.read(source);
  const auto fromX = static_cast<int>(bigEndian(std::span(source).first(2)));
  const auto fromY = static_cast<int>(bigEndian(std::span(source).last(2)));
  requireInside(rfb, rect, fromX, fromY, "that copies from");
  rfb.jpegWorkers.waitFor(boxAt(fromX, fromY, rect.size));
  const std::size_t row = std::size_t{4} * static_cast<std::size_t>(rect.size.width);
  for (int i = 0; i < rect.size.height; ++i) {
    // Where both overlap, what is copied from must not have been written to yet.
    const int line = fromY < rect.y ? rect.size.height - 1 - i : i;
    std::memmove(pixelAt(rfb, rect.x, rect.y + line), pixelAt(rfb, fromX, fromY + line), row);
  }
}

// libvncclient takes whole messages only: it finds the head of one with this rectangle alone in front of what it reads.
void decode(RfbState& rfb, const Rectangle& rect) {
  std::array<std::uint8_t, 16> head{0, 0, 0, 1};
  std::ranges::copy(rect.bytes, head.begin() + 4);
  rfb.giveBack(head);
  if (HandleRFBServerMessage(rfb.client) == FALSE) rfb.fail();
  if (rfb.log.damaged()) rfb.refuse("sent a damaged update: " + rfb.log.last());
}

void readPixels(RfbState& rfb, const Rectangle& rect) {
  requireInside(rfb, rect, rect.x, rect.y, "that lies");
  rfb.jpegWorkers.waitFor(boxAt(rect.x, rect.y, rect.size));
  if (rect.encoding == kRawEncoding) {
    readRaw(rfb, rect);
  } else if (rect.encoding == kCopyRectEncoding) {
    copyRect(rfb, rect);
  } else {
    decode(rfb, rect);
  }
  rfb.damage.add(boxAt(rect.x, rect.y, rect.size));
}

void resize(RfbState& rfb, devices::Size size) {
  rfb.resize(size);
  rfb.requestUpdate(false);
  if (rfb.continuousUpdates) rfb.enableContinuousUpdates();
}

[[noreturn]] void refuseEncoding(const RfbState& rfb, std::int32_t encoding) {
  rfb.refuse("sent a rectangle in encoding " + std::to_string(encoding) + ", which was not asked for");
}

// False after the last rectangle of an update that did not say how many there are.
bool readAny(RfbState& rfb, const Rectangle& rect) {
  switch (rect.encoding) {
    case kRawEncoding:
    case kCopyRectEncoding:
    case kTightEncoding:
    case kZrleEncoding:
      readPixels(rfb, rect);
      break;
    case kDesktopSizeEncoding:
      resize(rfb, rect.size);
      break;
    case kExtendedDesktopSizeEncoding:
      if (!rfb.options.mayResize) refuseEncoding(rfb, rect.encoding);
      if (readExtendedDesktopSize(rfb, rect.x, rect.y, rect.size)) resize(rfb, rect.size);
      break;
    case kRichCursorEncoding:
      readRichCursor(rfb, rect.size, rect.x, rect.y);
      break;
    case kXCursorEncoding:
      readXCursor(rfb, rect.size, rect.x, rect.y);
      break;
    case kCursorWithAlphaEncoding:
      readAlphaCursor(rfb, rect.size, rect.x, rect.y);
      break;
    case kPointerPosEncoding:
    case kVmwareCursorPositionEncoding:
      appendEvent(rfb.events, CursorMoved{rect.x, rect.y});
      break;
    case kExtendedMouseButtonsEncoding:
      rfb.extendedButtons = true;
      break;
    case kLastRectEncoding:
      return false;
    default:
      refuseEncoding(rfb, rect.encoding);
  }
  return true;
}

}  // namespace

void readUpdate(RfbState& rfb) {
  std::array<std::uint8_t, 3> head{};
  rfb.read(head);
  rfb.insideUpdate = true;
  // A server that answers while this one is decoded saves the way there and back.
  if (!rfb.continuousUpdates) rfb.requestUpdate(true);
  std::uint32_t left = bigEndian(std::span(head).last(2));
  while (left > 0 && readAny(rfb, readRectangle(rfb))) --left;
  rfb.finishPictures();
  rfb.insideUpdate = false;
  rfb.updateFinished = rfb.everUpdated = true;
  requestWantedLayout(rfb);
}

}  // namespace pixelflex::viewer
