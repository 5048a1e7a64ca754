#pragma once

#include <string>
#include <string_view>

namespace pixelflex::viewer {

/// RFB's plain clipboard is Latin-1; ours is UTF-8.
[[nodiscard]] std::string utf8FromLatin1(std::string_view latin1);

/// What Latin-1 cannot hold, and every malformed byte, becomes a question mark.
[[nodiscard]] std::string latin1FromUtf8(std::string_view utf8);

/// Desktop names are UTF-8 from some servers and Latin-1 from others: kept when they are well-formed UTF-8.
[[nodiscard]] std::string utf8FromEither(std::string_view text);

/// Line ends as RFB's Extended Clipboard has them (CR LF), and as X has them (LF). A lone CR counts as one.
[[nodiscard]] std::string withCrLf(std::string_view text);
[[nodiscard]] std::string withPlainLineEnds(std::string_view text);

}  // namespace pixelflex::viewer
