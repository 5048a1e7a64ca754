#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "calib/patterns/blob_pattern.h"
#include "calib/simulate/rig_generator.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/calibrated_rig.h"

// Time and memory of `pixelflex calibrate` from photographs on disk to the finished store and report: the whole
// program, from its start to its end. One line of JSON for each run, and a table of time against the number of
// projectors.

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;

struct Cost {
  double seconds = 0;
  double cpuSeconds = 0;  // of all threads
  double peakMegabytes = 0;
};

double secondsOf(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
}

/// Runs in a process of its own, so that neither memory nor threads carry over. Throws when it fails.
Cost apart(const std::function<void()>& work) {
  std::fflush(stdout);
  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    try {
      work();
      _exit(0);
    } catch (const std::exception& error) {
      fmt::print(stderr, "calibrate_bench: {}\n", error.what());
    }
    _exit(1);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  if (status != 0) throw std::runtime_error("a part of the benchmark failed; --show shows what the program says");
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
          secondsOf(usage.ru_utime) + secondsOf(usage.ru_stime), static_cast<double>(usage.ru_maxrss) / 1024};
}

/// Becomes the program; its standard output goes nowhere unless `show`.
void become(std::vector<std::string> arguments, bool show) {
  if (!show) dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDOUT_FILENO);
  std::vector<char*> pointers;
  for (auto& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  execv(pointers.front(), pointers.data());
  throw std::runtime_error("cannot start " + arguments.front());
}

constexpr std::size_t kColours = 3;  // full fields of red, green and blue

struct Settings {
  int repeat = 1;
  bool show = false;
};

/// A simulated wall in a folder, photographed and calibrated once; the photographs lie apart.
class Walls {
 public:
  Walls(const Rig& rig, const Settings& settings) : rig_(rig), settings_(settings) {
    apart([&] {
      SimulatedWall room(rig_);
      (void)calibrateRig(room, wall(), Method::kBlobs, {.uniformity = 0.5, .evenBlack = true});
    });
    fs::copy(wall() / "captures", photographs(), fs::copy_options::recursive);
  }

  /// The fastest of as many runs as the settings say, printed.
  Cost measure(const std::string& name, const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {PIXELFLEX_BIN_DIR "/pixelflex-calibrate", wall().string(), "--photos",
                                          photographs().string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    std::vector<Cost> costs;
    for (int i = 0; i < settings_.repeat; ++i) {
      costs.push_back(apart([&] { become(arguments, settings_.show); }));
    }
    const Cost cost = *std::ranges::min_element(costs, {}, &Cost::seconds);
    double load = 0;
    getloadavg(&load, 1);
    fmt::print(
        "{{\"benchmark\": \"{}\", \"projectors\": {}, \"resolution\": [{}, {}], \"photographs\": {}, "
        "\"camera\": [{}, {}], \"seconds\": {:.3f}, \"cpu_seconds\": {:.3f}, \"peak_mb\": {:.0f}, \"runs\": {}, "
        "\"load\": {:.1f}}}\n",
        name, rig_.projectors.size(), rig_.projectors.front().resolution.width,
        rig_.projectors.front().resolution.height, rig_.projectors.size() * (kPatternCount + kColours),
        rig_.camera.size.width, rig_.camera.size.height, cost.seconds, cost.cpuSeconds, cost.peakMegabytes,
        settings_.repeat, load);
    return cost;
  }

 private:
  [[nodiscard]] fs::path wall() const { return folder_.path() / "wall"; }
  [[nodiscard]] fs::path photographs() const { return folder_.path() / "photographs"; }
  testing::TemporaryFolder folder_;
  Rig rig_;
  Settings settings_;
};

struct Layout {
  int columns = 1, rows = 1;
};

/// As square as possible, wider than high.
Layout layoutOf(int projectors) {
  int rows = 1;
  for (int i = 2; i * i <= projectors; ++i) rows = projectors % i == 0 ? i : rows;
  return {projectors / rows, rows};
}

/// Everything, light alone, and one projector measured again, on the report's wall (or a tiny one).
void runWhole(const Settings& settings, bool tiny) {
  Walls wall(tiny ? miniRig(2) : reportRig(8), settings);
  wall.measure("all", {"--all"});
  wall.measure("light", {"blend", "gamma"});
  wall.measure("only", {"--only", tiny ? "p2" : "p3"});
}

/// Small projectors and a camera large enough for the most of them, so that only their number differs.
void runLinear(const Settings& settings, const std::vector<int>& numbers) {
  std::vector<Cost> costs;
  for (const int number : numbers) {
    const Layout layout = layoutOf(number);
    Walls wall(casualRig(layout.columns, layout.rows, {640, 480}, 8, {3840, 2160}), settings);
    costs.push_back(wall.measure("linear", {"--all"}));
  }
  fmt::print("projectors  seconds  seconds per projector  processor seconds  peak MB\n");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Cost& cost = costs[i];
    fmt::print("{:10}  {:7.2f}  {:21.3f}  {:17.2f}  {:7.0f}\n", numbers[i], cost.seconds, cost.seconds / numbers[i],
               cost.cpuSeconds, cost.peakMegabytes);
  }
}

}  // namespace
}  // namespace pixelflex::calib

int main(int argc, char** argv) {
  CLI::App app("Calibrates simulated walls from photographs on disk and prints time and memory as JSON lines");
  pixelflex::calib::Settings settings;
  std::vector<std::string> what = {"whole", "linear"};
  std::vector<int> projectors = {2, 8, 32};
  bool tiny = false;
  app.add_option("--what", what,
                 "whole: all, light alone and one projector of the report's wall; linear: walls of many sizes")
      ->delimiter(',')
      ->check(CLI::IsMember({"whole", "linear"}));
  app.add_option("--projectors", projectors, "How many, by commas, of linear")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  app.add_option("--repeat", settings.repeat, "Run each this often and keep the fastest")->check(CLI::PositiveNumber);
  app.add_flag("--show", settings.show, "What the program says, too");
  app.add_flag("--tiny", tiny, "Two small projectors and a small camera, to see that this works");
  CLI11_PARSE(app, argc, argv);
  const auto asked = [&](const char* one) { return std::ranges::find(what, one) != what.end(); };
  try {
    if (asked("whole") || tiny) pixelflex::calib::runWhole(settings, tiny);
    if (asked("linear") && !tiny) pixelflex::calib::runLinear(settings, projectors);
  } catch (const std::exception& error) {
    fmt::print(stderr, "calibrate_bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
