// pixelflex desktop WALL [OPTIONS] [-- COMMAND…]: an X desktop of the wall's own size, on the wall.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib/programs/command_line.h"
#include "calib/store/store.h"
#include "viewer/programs/desktop_command.h"
#include "viewer/programs/desktop_household.h"
#include "viewer/programs/desktop_server.h"
#include "viewer/vnc/session.h"

namespace pixelflex::viewer {
namespace {

devices::Size sizeOf(const std::string& wall) {
  const auto calibration = calib::loadCalibration(wall);
  if (!calibration.display || calibration.projectors.empty()) {
    throw std::runtime_error(wall + ": the wall is not fully calibrated: run pixelflex calibrate " + wall);
  }
  const devices::Size size = calibration.display->resolution;
  if (size.width <= kMaxDesktopExtent && size.height <= kMaxDesktopExtent) return size;
  throw std::runtime_error(
      fmt::format("{}: its desktop of {}x{} is more than the {} pixels each way that Xvnc has: "
                  "give a smaller desktop: density in wall.yaml",
                  wall, size.width, size.height, kMaxDesktopExtent));
}

std::string viewerProgram() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "pixelflex-view";
}

std::vector<std::string> viewerCommand(const DesktopOptions& options, const DesktopServer& server) {
  std::vector<std::string> command = {viewerProgram(), options.wall, "unix:" + server.socket().string(), "--resize"};
  command.insert(command.end(), options.viewing.begin(), options.viewing.end());
  return command;
}

std::map<std::string, std::string> environmentOf(const DesktopServer& server) {
  return {{"DISPLAY", server.display()},
          {"XAUTHORITY", server.cookies()},
          {"XDG_SESSION_TYPE", "x11"},
          {"WAYLAND_DISPLAY", ""},
          {"SESSION_MANAGER", ""}};
}

std::string endOf(const std::vector<std::string>& command, int status, bool atOnce) {
  const std::string when = atOnce ? " at once" : "";
  if (status > 128) return fmt::format("{} was ended{} by signal {}", command.front(), when, status - 128);
  return fmt::format("{} ended{} with status {}", command.front(), when, status);
}

/// Until one of the three ends or a signal comes: the exit status.
int watch(Household& household, const DesktopServer& server, const DesktopOptions& options, pid_t viewer,
          pid_t command) {
  const auto begun = std::chrono::steady_clock::now();
  while (true) {
    const auto event = household.wait(std::nullopt);
    if (event.quit) return 0;
    if (const auto status = household.statusOf(viewer)) return *status;
    if (household.statusOf(server.pid())) throw std::runtime_error("Xvnc ended: " + server.lastWords());
    const auto status = event.ended == command ? household.statusOf(command) : std::nullopt;
    if (!status) continue;
    const bool atOnce = std::chrono::steady_clock::now() - begun < std::chrono::seconds(5);
    if (*status != 0) throw std::runtime_error(endOf(options.command, *status, atOnce));
    // What it has drawn is to be seen on the screenshot.
    if (!options.takesScreenshot()) return 0;
  }
}

int runDesktop(const DesktopOptions& options) {
  const devices::Size size = sizeOf(options.wall);
  Household household;
  const DesktopServer server(household, size, "PixelFlex " + options.wall);
  if (server.interrupted()) return 0;
  fmt::print("a desktop of {}x{}: DISPLAY={} XAUTHORITY={}\n", size.width, size.height, server.display(),
             server.cookies().string());
  std::fflush(stdout);
  const pid_t command = household.start(options.command, {.environment = environmentOf(server)});
  const pid_t viewer = household.start(viewerCommand(options, server),
                                       {.environment = {{"PIXELFLEX_XAUTHORITY", server.cookies().string()}}});
  // The viewer first: it must not see the others go.
  const auto endAll = [&] {
    for (const pid_t child : {viewer, command, server.pid()}) household.end(child);
  };
  try {
    const int status = watch(household, server, options, viewer, command);
    endAll();
    return status;
  } catch (...) {
    endAll();
    throw;
  }
}

DesktopOptions parse(CLI::App& app, const std::vector<std::string>& arguments) {
  DesktopOptions options;
  app.add_option("WALL", options.wall, "the wall's folder")->required();
  app.allow_extras();
  app.footer(
      "OPTIONS are those of pixelflex view (--headless, --screenshot DIR, --projectors NAME,… and so on).\n"
      "COMMAND is what runs on the desktop; when it ends, all does. Without one it is the first that is installed "
      "of x-session-manager, openbox, x-window-manager, x-terminal-emulator, xterm.");
  const auto cut = std::ranges::find(arguments, "--");
  std::vector<std::string> own(arguments.begin(), cut);
  std::ranges::reverse(own);  // CLI11 takes them from the end
  app.parse(own);
  options.viewing = app.remaining();
  if (cut != arguments.end()) options.command.assign(cut + 1, arguments.end());
  return options;
}

}  // namespace
}  // namespace pixelflex::viewer

int main(int argc, char** argv) {
  using namespace pixelflex;
  CLI::App app(
      "Runs an X desktop of the wall's own size and shows it on the wall: pixelflex desktop WALL [OPTIONS] [-- "
      "COMMAND…].",
      "pixelflex desktop");
  viewer::DesktopOptions options;
  const auto parse = [&] { options = viewer::parse(app, {argv + std::min(argc, 1), argv + argc}); };
  return calib::runCommand(app, parse, [&] {
    if (options.command.empty()) options.command = viewer::defaultDesktopCommand();
    return viewer::runDesktop(options);
  });
}
