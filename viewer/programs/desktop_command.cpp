#include "viewer/programs/desktop_command.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace pixelflex::viewer {
namespace {

namespace fs = std::filesystem;

bool isProgram(const fs::path& file) {
  return fs::is_regular_file(file) && ::access(file.c_str(), X_OK) == 0;
}

}  // namespace

std::optional<fs::path> findProgram(const std::string& name) {
  if (name.find('/') != std::string::npos) return isProgram(name) ? std::optional<fs::path>(name) : std::nullopt;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/local/bin:/usr/bin:/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (isProgram(fs::path(folder) / name)) return fs::path(folder) / name;
  }
  return std::nullopt;
}

std::vector<std::string> defaultDesktopCommand() {
  for (const std::string name : {"x-session-manager", "openbox", "x-window-manager", "x-terminal-emulator", "xterm"}) {
    if (!findProgram(name)) continue;
    // A second session of the same user on the first one's bus would talk to the first one's programs.
    if (name == "x-session-manager" && findProgram("dbus-run-session")) return {"dbus-run-session", "--", name};
    return {name};
  }
  throw std::runtime_error(
      "no desktop to run: install a window manager (apt install openbox), or give a command after --");
}

bool DesktopOptions::takesScreenshot() const {
  return std::ranges::any_of(viewing, [](const std::string& option) { return option.starts_with("--screenshot"); });
}

}  // namespace pixelflex::viewer
