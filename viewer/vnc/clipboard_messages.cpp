#include "viewer/vnc/clipboard_messages.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "viewer/vnc/rfb_messages.h"
#include "viewer/vnc/text_encoding.h"

namespace pixelflex::viewer {
namespace {

constexpr std::uint32_t kAllActions =
    kClipboardCaps | kClipboardRequest | kClipboardPeek | kClipboardNotify | kClipboardProvide;
constexpr std::uint32_t kFormats = 0xffff;

std::vector<std::uint8_t> message(std::uint32_t flags, std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> bytes{6, 0, 0, 0};
  appendNumber(bytes, static_cast<std::uint32_t>(-static_cast<std::int32_t>(4 + payload.size())), 4);
  appendNumber(bytes, flags, 4);
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return bytes;
}

std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<std::uint8_t> packed(size);
  if (compress2(packed.data(), &size, bytes.data(), bytes.size(), Z_BEST_SPEED) != Z_OK) throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

/// Unpacks as much as is asked for and no more.
class Inflater {
 public:
  explicit Inflater(std::span<const std::uint8_t> packed) {
    stream_.next_in = const_cast<Bytef*>(packed.data());  // NOLINT: zlib's interface knows no const
    stream_.avail_in = static_cast<uInt>(packed.size());
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  bool read(std::span<std::uint8_t> bytes) {
    stream_.next_out = bytes.data();
    stream_.avail_out = static_cast<uInt>(bytes.size());
    while (stream_.avail_out > 0) {
      if (inflate(&stream_, Z_SYNC_FLUSH) != Z_OK) break;
    }
    return stream_.avail_out == 0;
  }

 private:
  z_stream stream_{};
};

}  // namespace

std::vector<std::uint8_t> clipboardCapsMessage(std::uint32_t textBytes) {
  std::vector<std::uint8_t> payload;
  appendNumber(payload, textBytes, 4);
  return message(kAllActions | kClipboardText, payload);
}

std::vector<std::uint8_t> clipboardFlagsMessage(std::uint32_t flags) {
  return message(flags, {});
}

std::vector<std::uint8_t> clipboardProvideMessage(std::string_view text) {
  const std::string lines = withCrLf(text) + '\0';
  std::vector<std::uint8_t> bytes;
  appendNumber(bytes, static_cast<std::uint32_t>(lines.size()), 4);
  bytes.insert(bytes.end(), lines.begin(), lines.end());
  return message(kClipboardProvide | kClipboardText, deflated(bytes));
}

ClipboardCaps parseClipboardCaps(std::uint32_t flags, std::span<const std::uint8_t> bytes) {
  ClipboardCaps caps{flags, 0};
  // One size for each format, the lowest bit's first: that is text.
  if ((flags & kClipboardText) != 0 && bytes.size() >= 4) caps.textBytes = bigEndian(bytes.first(4));
  return caps;
}

std::optional<std::size_t> parseProvidedSize(std::uint32_t flags, std::span<const std::uint8_t> bytes) {
  if ((flags & kFormats & kClipboardText) == 0) return std::nullopt;
  std::vector<std::uint8_t> head(4);
  if (!Inflater(bytes).read(head)) return std::nullopt;
  return bigEndian(head);
}

std::optional<std::string> parseProvidedText(std::uint32_t flags, std::span<const std::uint8_t> bytes,
                                             std::size_t limit) {
  if ((flags & kFormats & kClipboardText) == 0) return std::nullopt;
  Inflater stream(bytes);
  std::vector<std::uint8_t> head(4);
  if (!stream.read(head)) return std::nullopt;
  const std::size_t size = bigEndian(head);
  if (size > limit) return std::nullopt;
  std::vector<std::uint8_t> characters(size);
  if (!stream.read(characters)) return std::nullopt;
  std::string text(characters.begin(), std::ranges::find(characters, std::uint8_t{0}));
  return withPlainLineEnds(utf8FromEither(text));
}

}  // namespace pixelflex::viewer
