// Clicks all over the control panel of a wall of simulated devices, one of them dead, and tells how long its frames
// took. Ends with an error when the panel does.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "calib/store/store.h"
#include "devices/serve/device_host.h"
#include "devices/simulate/simulators.h"
#include "tests/e2e/programs.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

constexpr int kProjectors = 4;
constexpr int kWidth = 1280;
constexpr int kHeight = 720;

/// Flat screens: a calibration of them needs no camera.
void makeWall(const std::filesystem::path& folder, devices::DeviceHost& host) {
  calib::Wall wall;
  wall.camera.source = "none";
  for (int i = 0; i < kProjectors; ++i) {
    calib::ProjectorConfig projector;
    projector.name = "p" + std::to_string(i + 1);
    projector.resolution = {1024, 768};
    projector.flatAt = {1024 * i, 0};
    host.add(projector.name + ".control", devices::makeSimulator("proxima-dp6850"));
    host.add(projector.name + ".mirror", devices::makeSimulator("ptu"));
    projector.control = {"proxima-dp6850", host.address(projector.name + ".control"), {}};
    projector.mirror = {"ptu", host.address(projector.name + ".mirror"), {}};
    wall.projectors.push_back(projector);
  }
  std::filesystem::create_directory(folder);
  calib::saveWall(folder, wall);
  calib::saveCalibration(folder, calib::flatCalibration(wall));
  host.order("p4.mirror", devices::Fault::kSilent);
}

/// A few clicks, drags, turns of the wheel and keys, anywhere.
std::vector<std::string> anything(std::mt19937& random) {
  const auto upTo = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(most)); };
  std::vector<std::string> command = {"xdotool"};
  const auto add = [&](const std::vector<std::string>& words) {
    command.insert(command.end(), words.begin(), words.end());
  };
  for (int i = 0; i < 8; ++i) {
    const auto move = [&] { add({"mousemove", std::to_string(upTo(kWidth)), std::to_string(upTo(kHeight))}); };
    move();
    add({"mousedown", "1"});
    if (upTo(4) == 0) move();
    add({"mouseup", "1"});
    if (upTo(8) == 0) add({"click", upTo(2) == 0 ? "4" : "5"});
    if (upTo(8) == 0)
      add({"key", std::vector<std::string>{"Tab", "space", "Down", "Escape", "F12", "alt+Right"}.at(
                      static_cast<std::size_t>(upTo(6)))});
    add({"sleep", "0.02"});
  }
  return command;
}

int clickAround(int seconds, unsigned seed) {
  const TemporaryFolder folder;
  devices::DeviceHost host;
  makeWall(folder / "wall", host);
  XServer screen([](const TemporaryFolder&) {
    return std::vector<std::string>{"Xvfb", "-screen", "0", "1280x720x24", "-nolisten", "tcp", "-noreset"};
  });
  Process panel({std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-panel", (folder / "wall").string(), "--stats",
                 "--controls", (folder / "controls").string()},
                {.environment = {"DISPLAY=" + screen.display()}, .log = folder / "log"});
  while (!std::filesystem::exists(folder / "controls") && panel.running()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::mt19937 random(seed);
  int clicks = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
  for (; std::chrono::steady_clock::now() < end && panel.running(); clicks += 8) screen.query(anything(random));
  panel.signal(SIGTERM);
  const auto status = panel.wait(std::chrono::seconds(60));
  fmt::print("{} clicks in {} s: {}", clicks, seconds, textOf(folder / "log"));
  return status == 0 ? 0 : 1;
}

}  // namespace
}  // namespace pixelflex::testing

int main(int argc, char** argv) {
  CLI::App app("How long the control panel's frames take while somebody clicks all over it.");
  int seconds = 60;
  unsigned seed = 1;
  app.add_option("--seconds", seconds, "How long (60)");
  app.add_option("--seed", seed, "Of the clicks (1)");
  CLI11_PARSE(app, argc, argv);
  return pixelflex::testing::clickAround(seconds, seed);
}
