// pixelflex view WALL SERVER: a desktop on the wall, a VNC server's or an X server's.

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

#include "calib/programs/command_line.h"
#include "calib/store/store.h"
#include "viewer/programs/display_viewers.h"
#include "viewer/programs/headless.h"
#include "viewer/programs/password.h"
#include "viewer/programs/view_command.h"
#include "viewer/programs/view_options.h"
#include "viewer/programs/view_security.h"
#include "viewer/programs/wall_view.h"
#include "viewer/programs/windows.h"

namespace pixelflex::viewer {
namespace {

int view(const ViewOptions& options) {
  const WallPlan wall(options.wall, calib::loadWall(options.wall), calib::loadCalibration(options.wall),
                      options.projectors, options.fit);
  if (options.headless) return runHeadless(options, wall);
  const auto shares = sharesOfDisplays(wall);
  return shares.empty() ? runWindows(options, wall) : runViewers(options, shares, view);
}

// Asks for the password only when a server wants one that was not given.
int viewWithPassword(ViewOptions& options) {
  completeSecurity(options);
  try {
    return view(options);
  } catch (const PasswordNeeded& needed) {
    if (options.password) throw;
    options.password = askForPassword("Password for " + options.server.text() + ": ");
    if (!options.password) throw;
  }
  return view(options);
}

/// Where libXau looks by itself; unless it is named, it writes that into a buffer that all threads share.
void nameXauthority() {
  const char* const home = std::getenv("HOME");
  if (home != nullptr) ::setenv("XAUTHORITY", (std::string(home) + "/.Xauthority").c_str(), 0);
}

}  // namespace
}  // namespace pixelflex::viewer

int main(int argc, char** argv) {
  using namespace pixelflex;
  viewer::nameXauthority();
  CLI::App app(
      "Shows a desktop on the wall. SERVER is a VNC server, HOST:DISPLAY, HOST::PORT, [V6]::PORT or unix:PATH, or an X "
      "server of this machine, x11:DISPLAY (x11::7).",
      "pixelflex view");
  viewer::ViewOptions options;
  viewer::ViewTexts texts;
  viewer::defineOptions(app, options, texts);
  const auto parse = [&] {
    app.parse(argc, argv);
    viewer::take(texts, options);
  };
  return calib::runCommand(app, parse, [&] { return viewer::viewWithPassword(options); });
}
