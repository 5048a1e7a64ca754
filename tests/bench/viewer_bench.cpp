// What the whole viewer costs: its start, an idle desktop, the two kinds of source, memory. A line of JSON for each.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "calib/simulate/rig_generator.h"
#include "calib/store/store.h"
#include "tests/bench/desktop_client.h"
#include "tests/bench/measured_viewer.h"
#include "tests/bench/thread_times.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"
#include "tests/support_calibration/calibrated_rig.h"
#include "viewer/tiles/tile_layout.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;

struct Options {
  std::vector<std::string> what{"start", "idle", "windows", "source", "memory"};
  bool tiny = false;
  int starts = 7;
  double seconds = 10;  // of idleness, and of motion
};

/// The report's wall, calibrated once, and what its calibration wants of the desktop.
class Wall {
 public:
  explicit Wall(bool tiny) {
    calib::SimulatedWall room(tiny ? calib::miniRig(2) : calib::reportRig(8));
    const auto rig = calib::calibrateRig(room, folder_ / "wall", calib::Method::kBlobs, {.uniformity = 0.5});
    desktop_ = rig.calibration.display->resolution;
    projectors_ = rig.calibration.projectors.size();
    for (const auto& projector : rig.calibration.projectors)
      pixels_ += static_cast<double>(projector.resolution.area());
  }
  /// Each projector's picture in a window of an X screen, four side by side.
  void putOnto(const std::string& display) const {
    calib::Wall wall = calib::loadWall(folder_ / "wall");
    for (std::size_t i = 0; i < wall.projectors.size(); ++i) {
      const devices::Size size = wall.projectors[i].resolution;
      const glm::ivec2 place(static_cast<int>(i % 4), static_cast<int>(i / 4));
      wall.projectors[i].output = {
          .kind = calib::OutputKind::kDisplay, .display = display, .at = place * glm::ivec2(size.width, size.height)};
    }
    calib::saveWall(folder_ / "wall", wall);
  }
  [[nodiscard]] std::string folder() const { return (folder_ / "wall").string(); }
  [[nodiscard]] devices::Size desktop() const { return desktop_; }
  [[nodiscard]] std::size_t projectors() const { return projectors_; }
  /// Of all projectors together.
  [[nodiscard]] double pixels() const { return pixels_; }

 private:
  TemporaryFolder folder_;
  devices::Size desktop_;
  std::size_t projectors_ = 0;
  double pixels_ = 0;
};

double medianOf(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// Exec to first picture, the server running. The first start, which may find cold caches, is told apart.
void measureStart(const Options& options, const Wall& wall) {
  XvncServer server({.size = wall.desktop()});
  server.x().query({"xsetroot", "-solid", "#406080"});
  std::vector<double> seconds;
  std::vector<double> driver;
  std::vector<double> own;
  const double first = MeasuredViewer(wall.folder(), server.unixAddress()).waitForPicture();
  for (int i = 0; i < options.starts; ++i) {
    MeasuredViewer viewer(wall.folder(), server.unixAddress());
    seconds.push_back(viewer.waitForPicture());
    driver.push_back(viewer.times().driver);
    own.push_back(viewer.times().own());
  }
  fmt::print(
      R"({{"benchmark": "start", "projectors": {}, "desktop": [{}, {}], "starts": {}, "first_s": {:.3f}, "median_s": {:.3f}, "best_s": {:.3f}, "cpu_s": {:.3f}, "driver_cpu_s": {:.3f}}})"
      "\n",
      wall.projectors(), wall.desktop().width, wall.desktop().height, options.starts, first, medianOf(seconds),
      *std::ranges::min_element(seconds), medianOf(own), medianOf(driver));
}

void printIdle(const char* name, const ThreadTimes& used, double seconds) {
  fmt::print(
      R"({{"benchmark": "{}", "seconds": {:.1f}, "main_percent": {:.3f}, "other_percent": {:.3f}, "driver_percent": {:.3f}}})"
      "\n",
      name, seconds, 100 * used.main / seconds, 100 * used.others / seconds, 100 * used.driver / seconds);
}

void measureIdle(const Options& options, const Wall& wall) {
  XvncServer server({.size = wall.desktop()});
  for (const bool direct : {false, true}) {
    MeasuredViewer viewer(wall.folder(), direct ? "x11:" + server.x().display() : server.unixAddress());
    (void)viewer.waitForPicture();
    viewer.waitForRest();
    auto before = viewer.times();
    std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds));
    printIdle(direct ? "idle/x11" : "idle/vnc", viewer.times() - before, options.seconds);
    before = viewer.times();
    DesktopClient(server.x().display()).movePointer(options.seconds);
    printIdle(direct ? "pointer/x11" : "pointer/vnc", viewer.times() - before, options.seconds);
  }
}

/// A mouse that goes round in circles over an X screen, 60 times a second: seconds that it took.
double moveMouse(const XServer& screen, double seconds) {
  std::vector<std::string> command{"xdotool"};
  for (int i = 0; i < static_cast<int>(60 * seconds); ++i) {
    const auto part = [i](double phase) { return std::to_string(std::lround(12 * std::cos(0.03 * i + phase))); };
    command.insert(command.end(), {"mousemove_relative", "--", part(0), part(1.57), "sleep", "0.0166"});
  }
  const auto begun = std::chrono::steady_clock::now();
  (void)screen.query(command);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

/// The wall's own mouse over the desktop, as the viewer has it by itself on such a wall: each motion is drawn.
void measureWindows(const Options& options, const Wall& wall) {
  XvncServer server({.size = wall.desktop()});
  server.x().query({"xsetroot", "-solid", "#406080", "-cursor_name", "left_ptr"});
  const XServer screen([](const TemporaryFolder&) {
    return std::vector<std::string>{"Xvfb", "-screen", "0", "4096x1536x24", "-nolisten", "tcp", "-noreset"};
  });
  wall.putOnto(screen.display());
  MeasuredViewer viewer(wall.folder(), server.unixAddress(), {});
  (void)viewer.waitForPicture();
  viewer.waitForRest();
  auto before = viewer.times();
  std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds));
  printIdle("idle/windows", viewer.times() - before, options.seconds);
  before = viewer.times();
  const double moved = moveMouse(screen, options.seconds);
  printIdle("pointer/windows", viewer.times() - before, moved);
  const DrawnWork work = viewer.end();
  const double frames = work.outputs - static_cast<double>(wall.projectors());  // without the first of each
  fmt::print(R"({{"benchmark": "pointer/drawn", "motions": {}, "frames": {}, "kilopixels_a_frame": {:.2f}}})"
             "\n",
             static_cast<int>(60 * options.seconds), frames, (work.pixels - wall.pixels()) / 1e3 / frames);
}

/// A small wall, so that the desktop's way to the GPU is what costs.
void measureSource(const Options& options) {
  const devices::Size desktop = options.tiny ? devices::Size{800, 600} : devices::Size{7680, 4320};
  const int frames = options.tiny ? 2 : 6;
  TemporaryFolder folder;
  const std::string wall = (folder / "wall").string();
  if (run({PIXELFLEX_BIN_DIR "/pixelflex-new", wall, "--flat", "640x360"}).status != 0) {
    throw std::runtime_error("cannot make a flat wall");
  }
  XvncServer server({.size = desktop});
  const auto serverTimes = [&server] { return threadTimes(server.x().process().pid()).all(); };
  DesktopClient client(server.x().display());
  ThreadTimes vnc;
  double vncServer = 0;
  for (const bool direct : {false, true}) {
    MeasuredViewer viewer(wall, direct ? "x11:" + server.x().display() : server.unixAddress());
    (void)viewer.waitForPicture();
    viewer.waitForRest();
    ThreadTimes used;
    double serverUsed = 0;
    for (int i = 0; i < frames; ++i) {
      const auto before = viewer.times();
      const double serverBefore = serverTimes();
      client.repaint();
      std::this_thread::sleep_for(500ms);
      viewer.waitForRest();
      const auto after = viewer.times() - before;
      used.main += after.main / frames;
      used.others += after.others / frames;
      used.driver += after.driver / frames;
      serverUsed += (serverTimes() - serverBefore) / frames;
    }
    fmt::print(
        R"({{"benchmark": "source/{}", "desktop": [{}, {}], "frames": {}, "source_s": {:.4f}, "draw_s": {:.4f}, "driver_s": {:.4f}, "server_s": {:.4f})",
        direct ? "x11" : "vnc", desktop.width, desktop.height, frames, used.others, used.main, used.driver, serverUsed);
    if (direct) {
      fmt::print(R"(, "source_ratio": {:.2f}, "with_server_ratio": {:.2f}, "viewer_ratio": {:.2f})",
                 vnc.others / used.others, (vnc.others + vncServer) / (used.others + serverUsed),
                 vnc.all() / used.all());
    }
    fmt::print("}}\n");
    vnc = used;
    vncServer = serverUsed;
  }
}

/// What the software GL holds for the desktop.
double textureMegabytes(devices::Size desktop) {
  const viewer::TileLayout layout(desktop);
  const devices::Size tile{std::min(viewer::kTileExtent, desktop.width + 2 * viewer::kTileApron),
                           std::min(viewer::kTileExtent, desktop.height + 2 * viewer::kTileApron)};
  return 4.0 * static_cast<double>(tile.area()) * layout.count() / (1 << 20);
}

/// Two desktops of one shape: what grows with their pixels is told from what does not.
void measureMemory(const Options& options, const Wall& wall) {
  const devices::Size small{1024, 512};
  const devices::Size large = options.tiny ? devices::Size{2048, 1024} : devices::Size{16384, 8192};
  for (const bool direct : {false, true}) {
    double anonymousOfSmall = 0;
    double textureOfSmall = 0;
    for (const auto& desktop : {small, large}) {
      XvncServer server({.size = desktop});
      server.x().query({"xsetroot", "-mod", "5", "7", "-fg", "#80a0c0", "-bg", "#203040"});
      MeasuredViewer viewer(wall.folder(), direct ? "x11:" + server.x().display() : server.unixAddress());
      (void)viewer.waitForPicture();
      viewer.waitForRest();
      DesktopClient(server.x().display()).repaint();
      std::this_thread::sleep_for(500ms);
      viewer.waitForRest();
      const double anonymous = viewer.memory("RssAnon");
      const double texture = textureMegabytes(desktop);
      const double frame = 4.0 * static_cast<double>(desktop.area()) / (1 << 20);
      fmt::print(
          R"({{"benchmark": "memory/{}", "desktop": [{}, {}], "projectors": {}, "desktop_mb": {:.1f}, "texture_mb": {:.1f}, "rss_mb": {:.1f}, "anonymous_mb": {:.1f}, "files_mb": {:.1f}, "shared_mb": {:.1f}, "peak_mb": {:.1f})",
          direct ? "x11" : "vnc", desktop.width, desktop.height, wall.projectors(), frame, texture,
          viewer.memory("VmRSS"), anonymous, viewer.memory("RssFile"), viewer.memory("RssShmem"),
          viewer.memory("VmHWM"));
      if (desktop == large) {
        fmt::print(R"(, "without_texture_mb": {:.1f}, "grown_mb": {:.1f}, "grown_texture_mb": {:.1f})",
                   anonymous - texture, anonymous - anonymousOfSmall, texture - textureOfSmall);
      }
      fmt::print("}}\n");
      anonymousOfSmall = anonymous;
      textureOfSmall = texture;
    }
  }
}

int measure(const Options& options) {
  const auto asked = [&](const char* one) { return std::ranges::find(options.what, one) != options.what.end(); };
  if (asked("source")) measureSource(options);
  if (!asked("start") && !asked("idle") && !asked("windows") && !asked("memory")) return 0;
  const Wall wall(options.tiny);
  if (asked("start")) measureStart(options, wall);
  if (asked("idle")) measureIdle(options, wall);
  if (asked("memory")) measureMemory(options, wall);
  if (asked("windows")) measureWindows(options, wall);
  return 0;
}

}  // namespace
}  // namespace pixelflex::testing

int main(int argc, char** argv) {
  using namespace pixelflex::testing;
  Options options;
  CLI::App app(
      "What the whole viewer costs, headless but for the windows, on the report's wall. start: from exec to the first "
      "picture; idle: of a "
      "desktop that rests, and of one over which the pointer moves 60 times a second; windows: the same of the mouse "
      "over "
      "the projectors' windows; source: processor seconds when "
      "all "
      "of 7680x4320 pixels change, by VNC and straight from the X server; memory: of 16384x8192 pixels.");
  app.add_option("--what", options.what)
      ->delimiter(',')
      ->check(CLI::IsMember({"start", "idle", "windows", "source", "memory"}));
  app.add_option("--starts", options.starts)->check(CLI::Range(1, 1000));
  app.add_option("--seconds", options.seconds, "of idleness, and of motion")->check(CLI::Range(0.1, 3600.0));
  app.add_flag("--tiny", options.tiny, "two small projectors and small desktops, to see that this works");
  CLI11_PARSE(app, argc, argv);
  try {
    return measure(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "viewer_bench: {}\n", error.what());
    return 1;
  }
}
