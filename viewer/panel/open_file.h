#pragma once

#include <filesystem>

#include "viewer/control/wall_console.h"

namespace pixelflex::viewer {

/// Has the desktop open a file with the program that it has for it (xdg-open), and does not wait for it. What goes
/// wrong is said in the console's log.
void openFile(WallConsole& console, const std::filesystem::path& file);

}  // namespace pixelflex::viewer
