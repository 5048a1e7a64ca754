#pragma once

#include <optional>
#include <string>

#include "viewer/vnc/secret.h"

namespace pixelflex::viewer {

/// The password in a file that nobody else may read: its first line, or, when the file is exactly eight bytes that are
/// no text, what vncpasswd hid in them. Throws std::runtime_error that names the file and says what to do.
[[nodiscard]] Secret readPasswordFile(const std::string& file);

/// PIXELFLEX_VNC_PASSWORD, if it is set; takes it out of the environment, so that no child inherits it
/// and nobody finds it there.
[[nodiscard]] std::optional<Secret> takePasswordOfEnvironment();

/// Asks on the terminal, without an echo. Nothing when there is no terminal to ask on, when the answer
/// is empty, and when the program is told to quit.
[[nodiscard]] std::optional<Secret> askForPassword(const std::string& question);

}  // namespace pixelflex::viewer
