// pixelflex serve WALL --http [ADDRESS:]PORT --pjlink [ADDRESS:]PORT: a wall's remote controls.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "calib/programs/command_line.h"
#include "calib/store/store.h"
#include "calib/store/wall_devices.h"
#include "viewer/control/motion_watchdog.h"
#include "viewer/control/wall_console.h"
#include "viewer/programs/quit_signal.h"
#include "viewer/programs/serve_options.h"

namespace pixelflex::viewer {
namespace {

constexpr std::chrono::milliseconds kLogEvery{250};

std::vector<calib::WallDevice> mirrorsOf(const std::string& wall) {
  std::vector<calib::WallDevice> mirrors;
  std::ranges::copy_if(calib::devicesOf(calib::loadWall(wall), wall), std::back_inserter(mirrors),
                       &calib::WallDevice::isMirror);
  return mirrors;
}

/// What was ordered and what went wrong, for whoever keeps a log.
void printLog(const WallSnapshot& wall, std::uint64_t& printed) {
  for (const auto& line : wall.log) {
    if (line->number <= printed) continue;
    printed = line->number;
    fmt::print("{}{}\n", line->kind == LogLine::Kind::kError ? "error: " : "", line->text);
  }
  std::fflush(stdout);
}

int serve(const std::string& wall, const RemoteControlOptions& options) {
  const MotionWatchdog watchdog(mirrorsOf(wall));
  std::stop_source stop;
  const QuitSignal quit([&] { stop.request_stop(); });
  WallConsole console(wall);
  const RemoteControl control(console, options);
  for (const auto& place : placesOf(control)) fmt::print("{}\n", place);
  std::fflush(stdout);
  std::uint64_t printed = 0;
  while (!stop.stop_requested()) {
    printLog(*console.snapshot(), printed);
    std::this_thread::sleep_for(kLogEvery);
  }
  return 0;
}

void defineOptions(CLI::App& app, std::string& wall, ServeOptions& options) {
  app.add_option("WALL", wall, "The wall's folder")->required();
  defineServeOptions(app, options);
  app.footer(
      "PORT alone is reached from this machine only; 0.0.0.0:PORT or [::]:PORT from everywhere, which needs a token\n"
      "or a password.\n"
      "Neither is encrypted: use them in a network that you trust, or behind a server that adds TLS.\n"
      "GET    /                       a page: power, mute, presets, stop\n"
      "GET    /state                  devices, presets, jobs, calibration; /devices/NAME, /presets, /jobs/N,\n"
      "                               /log?after=N parts of it\n"
      "POST   /power /mute /freeze    {\"on\": true}: all projectors\n"
      "POST   /devices/NAMES          {\"pan\": 12.5, \"mute\": true} or [\"brightness+=5\", \"home\"], as\n"
      "                               pixelflex device takes them\n"
      "POST   /presets/NAME/restore   {\"verify\": true}, {\"dry_run\": true}\n"
      "PUT    /presets/NAME           saves what is now; DELETE deletes\n"
      "POST   /calibrate              {\"steps\": [\"gamma\"], \"all\": true, \"check\": true, \"only\": [\"p1\"]}\n"
      "POST   /halt                   stops every mirror; DELETE /jobs/N cancels a long job\n"
      "Orders are answered with their job at once (202); GET /jobs/N says what came of it. They need\n"
      "Content-Type: application/json. Example:\n"
      "  curl -H 'Content-Type: application/json' -d '{\"on\": true}' http://localhost:8080/power\n"
      "PJLink (port 4352 for room controllers): power, picture mute, freeze, errors, lamps, resolution of the whole "
      "wall.\n"
      "Its inputs are 51, the desktop, and the presets by the alphabet: 41 to 49, 4A to 4Z in class 2. At 0.0.0.0 it\n"
      "is found by search.");
}

}  // namespace
}  // namespace pixelflex::viewer

int main(int argc, char** argv) {
  using namespace pixelflex;
  CLI::App app("Lets programs, telephones and room controllers control a wall.", "pixelflex serve");
  std::string wall;
  viewer::ServeOptions options;
  viewer::defineOptions(app, wall, options);
  viewer::RemoteControlOptions remote;
  const auto parse = [&] {
    app.parse(argc, argv);
    if (!options.isWanted()) throw CLI::RequiredError("--http or --pjlink");
    remote = viewer::remoteControlOptions(options, wall);
  };
  return calib::runCommand(app, parse, [&] { return viewer::serve(wall, remote); });
}
