// pixelflex preset WALL list|save|restore|delete [NAME]: configurations of a wall under names.

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

#include "calib/programs/command_line.h"
#include "calib/store/preset.h"
#include "calib/store/store.h"
#include "calib/store/wall_devices.h"
#include "devices/transport/line_loop.h"
#include "viewer/control/motion_watchdog.h"
#include "viewer/control/preset_run.h"
#include "viewer/programs/quit_signal.h"

namespace pixelflex::viewer {
namespace {

struct PresetOptions {
  std::string wall;
  std::string action;
  std::string name;
  bool dryRun = false;
  bool verify = false;
  std::optional<double> recalibrate;  // pixels
};

int list(const PresetOptions& options) {
  for (const auto& name : calib::presetNames(options.wall)) {
    const calib::Preset preset = calib::loadPreset(options.wall, name);
    const bool inUse = preset.calibration && calib::isCalibrationInUse(options.wall, *preset.calibration);
    fmt::print("{}  {}  {} devices{}\n", name, preset.saved, preset.devices.size(),
               !preset.calibration ? ""
               : inUse             ? ", calibration in use"
                                   : ", calibration");
  }
  return 0;
}

/// 1 when there are errors.
int complain(const std::vector<PresetOutcome>& outcomes) {
  std::fflush(stdout);
  int status = 0;
  for (const auto& outcome : outcomes) {
    if (outcome.error.empty()) continue;
    fmt::print(stderr, "pixelflex-preset: {}\n", outcome.error);
    status = 1;
  }
  return status;
}

int save(const PresetOptions& options, PresetSession& session) {
  calib::checkPresetName(options.name);
  const calib::Preset preset = session.captureAs(options.name);
  const int status = complain(session.outcomes());
  calib::savePreset(options.wall, options.name, preset);
  fmt::print("{}: {} devices{}\n", options.name, preset.devices.size(),
             preset.calibration ? " and the calibration" : ", no calibration");
  if (status != 0) fmt::print(stderr, "pixelflex-preset: {} has of these devices what it had before\n", options.name);
  return status;
}

void printPlan(const std::vector<PresetStep>& plan, bool calibrates) {
  for (const PresetStage stage : kPresetStages) {
    if (stage == PresetStage::kCalibration && calibrates) fmt::print("calibration  the preset's\n");
    for (const auto& step : plan) {
      if (step.stage != stage) continue;
      std::string text;
      for (const auto& [name, value] : step.settings) text += " " + name + "=" + value;
      fmt::print("{:<12} {}{}\n", nameOf(stage), step.device, text);
    }
  }
}

/// Whether there is one that takes photographs by itself.
bool hasCamera(const std::string& folder) {
  const calib::Wall wall = calib::loadWall(folder);
  return !wall.isFlat() && wall.camera.source != "none" && wall.camera.source != "photos";
}

/// One photograph per projector, compared with the calibration, by the program that can.
int verify(const PresetOptions& options) {
  if (!hasCamera(options.wall)) {
    fmt::print("this wall has no camera of its own: nothing was verified\n");
    return 0;
  }
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "pixelflex-calibrate";
  std::vector<std::string> words = {program, options.wall, "--check"};
  if (options.recalibrate) {
    words.insert(words.end(), {"--recalibrate", fmt::format("{}", *options.recalibrate)});
  }
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  std::fflush(stdout);
  if (::posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ) != 0) {
    throw std::runtime_error(program + ": cannot be run, so nothing was verified");
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? 0 : 1;
}

int restore(const PresetOptions& options, PresetSession& session) {
  const auto begun = std::chrono::steady_clock::now();
  const calib::Preset preset = calib::loadPreset(options.wall, options.name);
  const auto plan = session.prepare(preset);
  const bool calibrates = preset.calibration && !calib::isCalibrationInUse(options.wall, *preset.calibration);
  if (options.dryRun) {
    printPlan(plan, calibrates);
    const int status = complain(session.outcomes());
    if (plan.empty() && !calibrates && status == 0) fmt::print("all is as {} has it\n", options.name);
    if (status != 0) fmt::print("of these devices nothing is known\n");
    return status;
  }
  session.restore(preset, plan, [](PresetStage stage) {
    fmt::print("{}\n", nameOf(stage));
    std::fflush(stdout);
  });
  int changed = 0;
  for (const auto& outcome : session.outcomes()) changed += outcome.changed;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  fmt::print("{}: {} settings changed, calibration {} in {:.2f} s\n", options.name, changed,
             calibrates ? "restored" : "as it was", took.count());
  return complain(session.outcomes());
}

std::vector<calib::WallDevice> mirrorsOf(const std::vector<calib::WallDevice>& devices) {
  std::vector<calib::WallDevice> mirrors;
  std::ranges::copy_if(devices, std::back_inserter(mirrors), &calib::WallDevice::isMirror);
  return mirrors;
}

int runWithDevices(const PresetOptions& options) {
  const auto devices = calib::devicesOf(calib::loadWall(options.wall), options.wall);
  const MotionWatchdog watchdog(options.action == "restore" && !options.dryRun ? mirrorsOf(devices)
                                                                               : std::vector<calib::WallDevice>());
  std::stop_source stop;
  const QuitSignal quit([&] { stop.request_stop(); });
  devices::LineLoop loop;
  PresetRunOptions run{.stop = stop.get_token()};
  if (::isatty(STDERR_FILENO) != 0) {
    run.report = [](const std::string& device, const std::string& state) {
      fmt::print(stderr, "{}: {}\n", device, state);
    };
  }
  PresetSession session(loop, options.wall, devices, run);
  const int status = options.action == "save" ? save(options, session) : restore(options, session);
  return quit.raised() ? 1 : status;
}

int runPreset(const PresetOptions& options) {
  if (options.action == "list") return list(options);
  if (options.action == "delete") {
    calib::deletePreset(options.wall, options.name);
    return 0;
  }
  const int status = runWithDevices(options);
  const bool verifies = options.verify || options.recalibrate;
  if (status != 0 || !verifies || options.dryRun || options.action != "restore") return status;
  return verify(options);
}

void defineOptions(CLI::App& app, PresetOptions& options) {
  app.add_option("WALL", options.wall, "The wall's folder")->required();
  app.add_option("ACTION", options.action, "list, save, restore or delete")
      ->required()
      ->check(CLI::IsMember({"list", "save", "restore", "delete"}));
  app.add_option("NAME", options.name, "The preset");
  app.add_flag("--dry-run", options.dryRun, "restore: only print what would be done");
  app.add_flag("--verify", options.verify, "restore: have the camera look afterwards how far each projector is off");
  app.add_option("--recalibrate", options.recalibrate,
                 "restore: as --verify, and projectors that are off by more than so many of their pixels are measured "
                 "again")
      ->check(CLI::Range(0.0, 1e4));
  app.footer(
      "A preset holds the settings of all devices and the calibration that belongs to them. Restoring changes only\n"
      "what differs, at all devices at once: mute, power, move, lens, colour, input, calibration, unmute. Ctrl+C "
      "halts\n"
      "what moves. A viewer that runs follows.");
}

}  // namespace
}  // namespace pixelflex::viewer

int main(int argc, char** argv) {
  using namespace pixelflex;
  CLI::App app("Saves and restores the wall's devices and calibration under names.", "pixelflex preset");
  viewer::PresetOptions options;
  viewer::defineOptions(app, options);
  const auto parse = [&] {
    app.parse(argc, argv);
    if (options.action != "list" && options.name.empty()) throw CLI::RequiredError("NAME");
  };
  return calib::runCommand(app, parse, [&] { return viewer::runPreset(options); });
}
