// pixelflex device WALL [NAME [SETTING[=VALUE]…]]: the settings of a wall's projectors and mirrors.

#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

#include "calib/programs/command_line.h"
#include "calib/store/store.h"
#include "calib/store/wall_devices.h"
#include "devices/projector_control/pjlink_search.h"
#include "devices/transport/line_loop.h"
#include "viewer/control/device_command.h"
#include "viewer/control/device_run.h"
#include "viewer/control/device_text.h"
#include "viewer/control/motion_watchdog.h"
#include "viewer/programs/quit_signal.h"

namespace pixelflex::viewer {
namespace {

struct DeviceOptions {
  std::string wall;
  std::string names = "all";
  std::vector<std::string> steps;
  bool json = false;
  bool quiet = false;
  bool search = false;
  bool lists = true;  // without a name
};

std::vector<calib::WallDevice> devicesIn(const std::string& folder) {
  auto found = calib::devicesOf(calib::loadWall(folder), folder);
  if (!found.empty()) return found;
  throw std::runtime_error(folder +
                           "/wall.yaml: none of its projectors has a control or a mirror; give them, for example, "
                           "control: {driver: pjlink, at: \"tcp://10.0.0.5:4352\"}");
}

std::vector<calib::WallDevice> movedBy(const std::vector<DeviceJob>& jobs) {
  std::vector<calib::WallDevice> moved;
  for (const auto& job : jobs) {
    if (job.moves()) moved.push_back(job.device);
  }
  return moved;
}

void print(const DeviceOptions& options, const std::vector<DeviceOutcome>& outcomes) {
  if (options.json) {
    fmt::print("{}", deviceJson(outcomes));
  } else {
    fmt::print("{}", options.lists ? deviceTable(outcomes) : deviceValues(outcomes));
  }
  std::fflush(stdout);
  for (const auto& [device, identity, values, error] : outcomes) {
    if (error.empty()) continue;
    const std::string name = error.starts_with(device.name) ? "" : device.name + ": ";
    fmt::print(stderr, "pixelflex-device: {}{}\n", name, error);
  }
}

int runDevice(const DeviceOptions& options, const std::vector<DeviceJob>& jobs) {
  const auto moved = movedBy(jobs);
  std::optional<MotionWatchdog> watchdog;
  if (!moved.empty()) watchdog.emplace(moved);
  std::stop_source stop;
  const QuitSignal quit([&] { stop.request_stop(); });
  devices::LineLoop loop;
  DeviceRunOptions run{.stop = stop.get_token()};
  if (!options.quiet && ::isatty(STDERR_FILENO) != 0) {
    run.report = [](const std::string& device, const std::string& state) {
      fmt::print(stderr, "{}: {}\n", device, state);
    };
  }
  const auto outcomes = runDeviceJobs(loop, jobs, run);
  print(options, outcomes);
  const bool failed = std::ranges::any_of(outcomes, [](const auto& outcome) { return !outcome.error.empty(); });
  return failed || quit.raised() ? 1 : 0;
}

/// As they answer.
int searchNetwork() {
  std::stop_source stop;
  const QuitSignal quit([&] { stop.request_stop(); });
  int count = 0;
  devices::searchPjlink({.stop = stop.get_token()}, [&](const devices::PjlinkFound& device) {
    fmt::print("{}  {}  control: {{driver: pjlink, at: \"tcp://{}:4352\"}}\n", device.host, device.hardware,
               device.host);
    std::fflush(stdout);
    ++count;
  });
  if (count == 0) fmt::print("no projector answered; only those of PJLink class 2 do\n");
  return quit.raised() ? 1 : 0;
}

void defineOptions(CLI::App& app, DeviceOptions& options) {
  app.add_option("WALL", options.wall, "The wall's folder");
  auto* names = app.add_option("NAME", options.names,
                               "all, or projectors and their devices: p1,p2.mirror; without it all are listed");
  app.add_option("SETTING", options.steps, "What to read (SETTING), set (=VALUE), step (+=N, -=N) or do");
  app.add_flag("--json", options.json, "Print JSON");
  app.add_flag("--search", options.search, "Look for PJLink projectors on the network, and say what to write for them");
  app.add_flag("--quiet", options.quiet, "Do not tell how far slow settings are");
  app.footer(
      "Mirrors:    pan tilt (degrees), pan_counts tilt_counts, pan_speed tilt_speed, pan_acceleration\n"
      "            tilt_acceleration, limits (on, off); home, reset, halt\n"
      "Projectors: power, input, mute, freeze, brightness, contrast, red, green, blue, zoom, focus, shift_h,\n"
      "            shift_v, lens_memory, hours, filter_hours, errors, as far as the device has them\n"
      "Examples:   pixelflex device WALL                          what there is, and its state\n"
      "            pixelflex device WALL p1                       every setting of p1\n"
      "            pixelflex device WALL p1 pan=12.5 tilt=-3      aims p1's mirror; returns when it is there\n"
      "            pixelflex device WALL p1,p2 brightness+=5 mute=off\n"
      "            pixelflex device WALL all halt                 stops every mirror\n"
      "            pixelflex device --search                      PJLink projectors on the network\n"
      "Devices work at the same time. A signal halts what moves; so does a watchdog when this program is killed.");
  app.callback([&options, names] { options.lists = names->empty(); });
}

}  // namespace
}  // namespace pixelflex::viewer

int main(int argc, char** argv) {
  using namespace pixelflex;
  CLI::App app("Lists, reads and sets the settings of a wall's projectors and mirrors.", "pixelflex device");
  viewer::DeviceOptions options;
  viewer::defineOptions(app, options);
  std::vector<viewer::DeviceJob> jobs;
  const auto parse = [&] {
    app.parse(argc, argv);
    if (options.search && options.wall.empty()) return;
    if (options.search) throw std::invalid_argument("--search looks at the network, not at a wall: leave the rest out");
    if (options.wall.empty()) throw CLI::RequiredError("WALL");
    jobs = viewer::planDevices(viewer::devicesIn(options.wall), options.names, options.steps);
  };
  return calib::runCommand(app, parse,
                           [&] { return options.search ? viewer::searchNetwork() : viewer::runDevice(options, jobs); });
}
