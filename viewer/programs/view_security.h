#pragma once

#include <string>

#include "viewer/programs/view_options.h"
#include "viewer/vnc/security.h"

namespace pixelflex::viewer {

/// Fills in what the command line leaves open: the password from its file or the environment, the user from the
/// environment, and where known servers are remembered: $XDG_CONFIG_HOME/pixelflex/known_servers, by default under
/// ~/.config. Throws std::runtime_error when the password file cannot be used.
void completeSecurity(ViewOptions& options);

/// What a person should know of a connection that has come about: a certificate trusted on first use, or that the way
/// over the network is not safe. Empty when there is nothing to say.
[[nodiscard]] std::string securityNotice(const ViewOptions& options, const ConnectionSecurity& security);

}  // namespace pixelflex::viewer
