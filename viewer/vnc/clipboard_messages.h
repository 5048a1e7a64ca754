#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pixelflex::viewer {

/// The Extended Clipboard of RFB: UTF-8, and nothing crosses the link before somebody pastes. Its messages are cut
/// texts with a negative length: four bytes of flags, then what the action needs.
inline constexpr std::uint32_t kClipboardText = 1u << 0;  // the only format here
inline constexpr std::uint32_t kClipboardCaps = 1u << 24;
inline constexpr std::uint32_t kClipboardRequest = 1u << 25;
inline constexpr std::uint32_t kClipboardPeek = 1u << 26;
inline constexpr std::uint32_t kClipboardNotify = 1u << 27;
inline constexpr std::uint32_t kClipboardProvide = 1u << 28;

/// What a server can do with its clipboard.
struct ClipboardCaps {
  std::uint32_t flags = 0;      // formats and actions
  std::uint32_t textBytes = 0;  // a text may be provided unasked up to here
  bool operator==(const ClipboardCaps&) const = default;
};

/// Client to server: text in every action, provided unasked up to `textBytes`.
[[nodiscard]] std::vector<std::uint8_t> clipboardCapsMessage(std::uint32_t textBytes);
/// Client to server: flags alone, for requests, peeks and notifications.
[[nodiscard]] std::vector<std::uint8_t> clipboardFlagsMessage(std::uint32_t flags);
/// Client to server: a text in UTF-8, whose line ends become CR LF.
[[nodiscard]] std::vector<std::uint8_t> clipboardProvideMessage(std::string_view text);

/// Of the bytes that follow the flags; what is missing counts as nothing.
[[nodiscard]] ClipboardCaps parseClipboardCaps(std::uint32_t flags, std::span<const std::uint8_t> bytes);
/// How many bytes a provided text has, unpacked; none when there is no text or the bytes are damaged.
[[nodiscard]] std::optional<std::size_t> parseProvidedSize(std::uint32_t flags, std::span<const std::uint8_t> bytes);
/// The text itself: UTF-8 with plain line ends. None when the bytes are damaged, or the text is not there
/// or longer than `limit` bytes; never unpacks more than that.
[[nodiscard]] std::optional<std::string> parseProvidedText(std::uint32_t flags, std::span<const std::uint8_t> bytes,
                                                           std::size_t limit);

}  // namespace pixelflex::viewer
