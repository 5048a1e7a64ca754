#pragma once

#include <optional>
#include <string>

#include "viewer/remote/http_message.h"

namespace pixelflex::viewer {

/// A page for telephones: state, power, mute, presets, halt. `file` is "" (the page), "status.css" or "status.js";
/// nothing for any other. It asks the wall itself, with the token that its user types, if one is needed.
[[nodiscard]] std::optional<HttpReply> statusPage(const std::string& file);

}  // namespace pixelflex::viewer
