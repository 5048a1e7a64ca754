#include "viewer/vnc/text_encoding.h"

#include <cstdint>
#include <optional>

namespace pixelflex::viewer {
namespace {

// Takes one code point off the front; on malformed input one byte, and the answer is empty.
std::optional<std::uint32_t> takeCodePoint(std::string_view& text) {
  const auto byteAt = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byteAt(0);
  const std::size_t length = lead < 0x80   ? 1
                             : lead < 0xc2 ? 0
                             : lead < 0xe0 ? 2
                             : lead < 0xf0 ? 3
                             : lead < 0xf5 ? 4
                                           : 0;
  std::uint32_t codePoint = length == 1 ? lead : lead & (0x7fu >> length);
  bool wellFormed = length != 0 && length <= text.size();
  for (std::size_t i = 1; wellFormed && i < length; ++i) {
    wellFormed = (byteAt(i) & 0xc0) == 0x80;
    codePoint = codePoint << 6 | (byteAt(i) & 0x3fu);
  }
  const bool tooLong = (length == 3 && codePoint < 0x800) || (length == 4 && codePoint < 0x10000);
  const bool surrogate = codePoint >= 0xd800 && codePoint < 0xe000;
  if (!wellFormed || tooLong || surrogate || codePoint > 0x10ffff) {
    text.remove_prefix(1);
    return std::nullopt;
  }
  text.remove_prefix(length);
  return codePoint;
}

}  // namespace

std::string utf8FromLatin1(std::string_view latin1) {
  std::string utf8;
  utf8.reserve(latin1.size());
  for (const char c : latin1) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      utf8.push_back(c);
    } else {
      utf8.push_back(static_cast<char>(0xc0 | byte >> 6));
      utf8.push_back(static_cast<char>(0x80 | (byte & 0x3f)));
    }
  }
  return utf8;
}

std::string latin1FromUtf8(std::string_view utf8) {
  std::string latin1;
  while (!utf8.empty()) {
    const std::optional<std::uint32_t> codePoint = takeCodePoint(utf8);
    latin1.push_back(codePoint && *codePoint < 0x100 ? static_cast<char>(*codePoint) : '?');
  }
  return latin1;
}

std::string utf8FromEither(std::string_view text) {
  for (std::string_view rest = text; !rest.empty();) {
    if (!takeCodePoint(rest)) return utf8FromLatin1(text);
  }
  return std::string(text);
}

std::string withPlainLineEnds(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') continue;
    plain.push_back(text[i] == '\r' ? '\n' : text[i]);
  }
  return plain;
}

std::string withCrLf(std::string_view text) {
  std::string lines;
  lines.reserve(text.size());
  for (const char c : withPlainLineEnds(text)) {
    if (c == '\n') lines.push_back('\r');
    lines.push_back(c);
  }
  return lines;
}

}  // namespace pixelflex::viewer
