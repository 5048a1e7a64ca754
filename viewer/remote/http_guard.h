#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "viewer/remote/http_message.h"

namespace pixelflex::viewer {

/// Whether two secrets are the same; takes as long wherever they differ.
[[nodiscard]] bool isSameSecret(std::string_view a, std::string_view b);

/// Why a request is refused before anybody looks at what it wants; nothing for one that may pass.
///
/// With a token every request must carry it ("Authorization: Bearer TOKEN"). Without one anybody of this machine may
/// ask, and with them every page that a browser of this machine shows: so Host must be a name of this machine that no
/// name server can redirect, Origin our own, and what changes something must say that it is JSON, which no page can do
/// without asking first.
[[nodiscard]] std::optional<HttpReply> refusal(const HttpRequest& request, const std::string& token);

/// Of pages that hold nothing secret and that a browser opens: as above, but without a token.
[[nodiscard]] std::optional<HttpReply> pageRefusal(const HttpRequest& request, const std::string& token);

}  // namespace pixelflex::viewer
