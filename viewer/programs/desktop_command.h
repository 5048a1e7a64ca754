#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pixelflex::viewer {

/// A program that PATH has, or a path to one.
[[nodiscard]] std::optional<std::filesystem::path> findProgram(const std::string& name);

/// What a desktop runs unless it is told: the first that is installed of x-session-manager (with a message bus of its
/// own), openbox, x-window-manager, x-terminal-emulator, xterm. Throws std::runtime_error when none is.
[[nodiscard]] std::vector<std::string> defaultDesktopCommand();

/// The command line of `pixelflex desktop`.
struct DesktopOptions {
  std::string wall;
  std::vector<std::string> viewing;  // options for pixelflex-view
  std::vector<std::string> command;  // empty: the default
  [[nodiscard]] bool takesScreenshot() const;
};

}  // namespace pixelflex::viewer
