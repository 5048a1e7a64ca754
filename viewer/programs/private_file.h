#pragma once

#include <string>

#include "viewer/vnc/secret.h"

namespace pixelflex::viewer {

/// What a file holds that nobody else may read, up to 4096 bytes; `what` says what that is ("password").
/// Throws std::runtime_error that names the file and says what to do.
[[nodiscard]] Secret readPrivateFile(const std::string& file, const std::string& what);

/// Its first line, which must not be empty.
[[nodiscard]] Secret readPrivateLine(const std::string& file, const std::string& what);

}  // namespace pixelflex::viewer
