// pixelflex panel WALL: the control panel.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib/programs/command_line.h"
#include "calib/store/store.h"
#include "calib/store/wall_devices.h"
#include "devices/display/event_loop.h"
#include "devices/image/png_file.h"
#include "viewer/control/child_program.h"
#include "viewer/control/motion_watchdog.h"
#include "viewer/control/wall_console.h"
#include "viewer/panel/panel.h"
#include "viewer/panel/panel_window.h"
#include "viewer/programs/frame_times.h"
#include "viewer/programs/panel_show.h"
#include "viewer/programs/quit_signal.h"

namespace pixelflex::viewer {
namespace {

constexpr std::array kTabs = {"map", "camera", "calibration", "presets"};

struct Options {
  std::string wall;
  std::string size = "1280x720";
  float scale = 1;
  std::string tab = kTabs.front();
  std::vector<std::string> projectors;
  std::string picture;
  std::string screenshot;
  std::string controls;
  bool untilEof = false;
  bool stats = false;
};

devices::Size sizeOf(const std::string& text) {
  devices::Size size;
  char rest = 0;
  // NOLINTNEXTLINE(cert-err34-c): out of range is caught below
  if (std::sscanf(text.c_str(), "%dx%d%c", &size.width, &size.height, &rest) == 2 && size.width >= 640 &&
      size.height >= 480 && size.width <= 16384 && size.height <= 16384) {
    return size;
  }
  throw CLI::ValidationError("--size", "\"" + text + "\" is no size; write WIDTHxHEIGHT, at least 640x480");
}

/// All devices have answered or are known to be lost, and so is the camera where it is looked at.
class Settled {
 public:
  bool operator()(const WallSnapshot& wall, const Panel& panel) {
    using namespace std::chrono;
    const auto now = steady_clock::now();
    const bool known = std::ranges::none_of(
        wall.devices, [](const auto& state) { return state->contact == DeviceState::Contact::kNotYet; });
    if ((!known || panel.awaitsCamera()) && now - begun_ < seconds(30)) settledAt_ = now;
    return now - settledAt_ > milliseconds(500);
  }

 private:
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point settledAt_ = begun_;
};

std::vector<calib::WallDevice> mirrorsOf(const std::string& folder) {
  auto mirrors = calib::devicesOf(calib::loadWall(folder), folder);
  std::erase_if(mirrors, [](const calib::WallDevice& device) { return !device.isMirror; });
  return mirrors;
}

/// The panel outlives its window, but not what it has on the GPU.
class PanelGraphics {
 public:
  explicit PanelGraphics(Panel& panel) : panel_(panel) {}
  ~PanelGraphics() { panel_.releaseGraphics(); }
  PanelGraphics(const PanelGraphics&) = delete;
  PanelGraphics& operator=(const PanelGraphics&) = delete;

 private:
  Panel& panel_;
};

/// Until the window is closed, a signal comes or the screenshot is made.
void runWindow(WallConsole& console, Panel& panel, const Options& options, const std::atomic<bool>& quit) {
  constexpr std::chrono::duration<double> kLook{0.03};
  devices::EventLoop loop;
  PanelWindow window(loop, "PixelFlex: " + options.wall, sizeOf(options.size), options.scale,
                     [&](const devices::KeyStroke& stroke) { return panel.shortcut(stroke); });
  const PanelGraphics graphics(panel);
  FrameTimes times;
  Settled settled;
  std::uint64_t shown = 0;
  while (!quit && !window.closed()) {
    loop.wait(window.needsFrame() ? std::chrono::duration<double>(0.001) : kLook);
    const bool idle = !window.needsFrame() && !panel.isPending() && panel.revision() == shown;
    if (idle && options.screenshot.empty()) continue;
    shown = panel.revision();
    times.begin();
    window.frame([&] { panel.draw(); });
    times.end();
    if (options.screenshot.empty() || !settled(*console.snapshot(), panel)) continue;
    devices::writePng(options.screenshot, window.picture(), devices::PngEffort::kSmall);
    break;
  }
  if (options.stats) fmt::print("{}\n", times.text());
}

void runPanel(const Options& options) {
  // Before any thread.
  const MotionWatchdog watchdog(mirrorsOf(options.wall));
  std::atomic<bool> quit = false;
  const QuitSignal signal([&] {
    quit = true;
    devices::EventLoop::wake();
  });
  WallConsole console(options.wall);
  PanelOptions panelOptions{.programs = programsFolder(), .controls = options.controls};
  panelOptions.choice.tab = options.tab;
  panelOptions.choice.projectors = {options.projectors.begin(), options.projectors.end()};
  Panel panel(console, panelOptions);
  runWindow(console, panel, options, quit);
}

void defineOptions(CLI::App& app, Options& options) {
  std::vector<std::string> pictures;
  for (const auto& picture : kTestPictures) pictures.emplace_back(picture.name);
  app.add_option("WALL", options.wall, "The wall's folder")->required();
  app.add_option("--size", options.size, "Of the window, pixels (1280x720)");
  app.add_option("--scale", options.scale, "Enlarges everything (1)")->check(CLI::Range(0.5, 4.0));
  app.add_option("--tab", options.tab, "To begin with: map, camera, calibration or presets")
      ->check(CLI::IsMember(std::vector<std::string>(kTabs.begin(), kTabs.end())));
  app.add_option("--projectors", options.projectors, "Chosen to begin with, or for --show: p1,p2")->delimiter(',');
  app.add_option(
         "--show", options.picture,
         "No panel: only show a test picture on --projectors, until Ctrl+C: off, name, grid, focus, white, red, "
         "green, blue")
      ->check(CLI::IsMember(pictures));
  // For the panel itself, so that no picture outlives it.
  app.add_flag("--until-eof", options.untilEof, "--show: until standard input ends, too")->group("");
  app.add_option("--screenshot", options.screenshot,
                 "Write what the panel shows to this PNG once all devices are known, and end");
  app.add_option("--controls", options.controls,
                 "For programs that drive the panel: keep a list of where each control is here");
  app.add_flag("--stats", options.stats, "At the end print how long frames took");
  app.footer(
      "Choose projectors on the left or on the map (Ctrl: one more, Shift: a row of them); what is set at the right "
      "goes\n"
      "to all of them at once. Dragging a footprint on the map aims its mirror. The log at the bottom has the command\n"
      "line of everything that is done.\n"
      "Keys: F12 stops every mirror; Alt+arrows aim the chosen mirrors; Tab, arrows, Space and Enter go anywhere.\n"
      "Mirrors halt when the panel ends, however it ends.");
}

void requireProjectors(const Options& options) {
  const auto known = calib::loadWall(options.wall).projectors;
  for (const auto& name : options.projectors) {
    if (std::ranges::find(known, name, &calib::ProjectorConfig::name) != known.end()) continue;
    throw std::invalid_argument("--projectors: wall.yaml has no projector " + name);
  }
}

int run(const Options& options) {
  if (options.picture.empty()) {
    runPanel(options);
  } else {
    showTestPicture(options.wall, options.projectors, options.picture, options.untilEof);
  }
  return 0;
}

}  // namespace
}  // namespace pixelflex::viewer

int main(int argc, char** argv) {
  using namespace pixelflex;
  CLI::App app("The control panel of a wall: projectors, mirrors, camera, calibration and presets.", "pixelflex panel");
  viewer::Options options;
  viewer::defineOptions(app, options);
  const auto parse = [&] {
    app.parse(argc, argv);
    (void)viewer::sizeOf(options.size);
    if (!options.picture.empty() && options.projectors.empty()) throw CLI::RequiredError("--projectors");
    viewer::requireProjectors(options);
  };
  return calib::runCommand(app, parse, [&] { return viewer::run(options); });
}
