#include "viewer/vnc/rfb_clipboard.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "viewer/vnc/event_queue.h"
#include "viewer/vnc/rfb_messages.h"
#include "viewer/vnc/text_encoding.h"

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kMaxPlainBytes = 256u << 10;  // what TigerVNC's server accepts
// Packing may make a text a little longer; flags and sizes of formats are small.
constexpr std::size_t kOverhead = 4096;

void leaveOut(RfbState& rfb) {
  if (rfb.options.clipboardLimit > 0) appendEvent(rfb.events, ClipboardRefused{true, rfb.options.clipboardLimit});
}

void readPlain(RfbState& rfb, std::uint32_t length) {
  if (length > rfb.options.clipboardLimit) {
    leaveOut(rfb);
    return rfb.discard(length);
  }
  std::string text(length, '\0');
  rfb.read({reinterpret_cast<std::uint8_t*>(text.data()), text.size()});
  if (!text.empty()) appendEvent(rfb.events, Clipboard{withPlainLineEnds(utf8FromLatin1(text))});
}

void provide(RfbState& rfb) {
  if (rfb.offeredText) rfb.write(clipboardProvideMessage(*rfb.offeredText));
}

void notify(RfbState& rfb) {
  rfb.write(clipboardFlagsMessage(kClipboardNotify | (rfb.offeredText ? kClipboardText : 0)));
}

// A server that says what it can do expects the same.
void agree(RfbState& rfb, const ClipboardCaps& caps) {
  rfb.clipboardCaps = caps;
  rfb.write(clipboardCapsMessage(static_cast<std::uint32_t>(rfb.options.clipboardLimit)));
  if (rfb.offeredText) notify(rfb);
}

void act(RfbState& rfb, std::uint32_t flags, std::span<const std::uint8_t> bytes) {
  if ((flags & kClipboardCaps) != 0) return agree(rfb, parseClipboardCaps(flags, bytes));
  const bool text = (flags & kClipboardText) != 0;
  if ((flags & kClipboardRequest) != 0 && text) provide(rfb);
  if ((flags & kClipboardPeek) != 0) notify(rfb);
  if ((flags & kClipboardNotify) != 0 && text) rfb.write(clipboardFlagsMessage(kClipboardRequest | kClipboardText));
  if ((flags & kClipboardProvide) == 0) return;
  if (parseProvidedSize(flags, bytes).value_or(0) > rfb.options.clipboardLimit) return leaveOut(rfb);
  if (auto received = parseProvidedText(flags, bytes, rfb.options.clipboardLimit)) {
    appendEvent(rfb.events, Clipboard{*std::move(received)});
  }
}

void readExtended(RfbState& rfb, std::uint32_t length) {
  if (length > rfb.options.clipboardLimit + kOverhead) leaveOut(rfb);
  if (length < 4 || length > rfb.options.clipboardLimit + kOverhead) return rfb.discard(length);
  std::vector<std::uint8_t> bytes(length);
  rfb.read(bytes);
  act(rfb, bigEndian(std::span(bytes).first(4)), std::span(bytes).subspan(4));
}

bool canNotify(const ClipboardCaps& caps) {
  constexpr std::uint32_t kNeeded = kClipboardNotify | kClipboardText;
  return (caps.flags & kNeeded) == kNeeded;
}

}  // namespace

void readClipboard(RfbState& rfb) {
  std::array<std::uint8_t, 7> header{};
  rfb.read(header);
  const std::uint32_t length = bigEndian(std::span(header).last(4));
  const bool extended = static_cast<std::int32_t>(length) < 0 && rfb.options.clipboardLimit > 0;
  if (extended) {
    readExtended(rfb, 0u - length);
  } else {
    readPlain(rfb, length);
  }
}

void offerClipboard(RfbState& rfb, const std::string& text) {
  rfb.offeredText.reset();
  if (rfb.options.clipboardLimit == 0) return;
  if (text.size() <= rfb.options.clipboardLimit) rfb.offeredText = text;
  if (rfb.clipboardCaps) {
    if (canNotify(*rfb.clipboardCaps)) return notify(rfb);
    if (rfb.offeredText && text.size() < rfb.clipboardCaps->textBytes) return provide(rfb);
  }
  const std::string latin1 = latin1FromUtf8(withPlainLineEnds(text));
  if (latin1.size() > kMaxPlainBytes) return appendEvent(rfb.events, ClipboardRefused{false, kMaxPlainBytes});
  if (rfb.offeredText) rfb.write(clipboardMessage(latin1));
}

}  // namespace pixelflex::viewer
