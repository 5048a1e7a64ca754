#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <map>
#include <string>

#include "calib/capture/folder_photographs.h"
#include "calib/patterns/blob_pattern.h"
#include "calib/simulate/rig_generator.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/calibrated_rig.h"

// Time and memory from photographs on disk to the finished store. One line of JSON for each number of projectors.

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

class TimedProgress : public Progress {
 public:
  void beginStep(const std::string& step) override {
    step_ = step;
    begin_ = Clock::now();
  }
  void advance(int, int, const std::string&) override {}
  void endStep(const std::string&) override {
    steps_ += fmt::format("{}\"{}\": {:.3f}", steps_.empty() ? "" : ", ", step_, secondsSince(begin_));
  }
  void warn(const std::string&) override {}
  [[nodiscard]] const std::string& steps() const { return steps_; }

 private:
  std::string step_;
  Clock::time_point begin_;
  std::string steps_;
};

/// The largest resident size of this process so far, MB.
double peakMegabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::strtod(line.c_str() + 6, nullptr) / 1024;
  }
  return 0;
}

struct Layout {
  int columns = 1, rows = 1;
};

/// As square as possible, wider than high.
Layout layoutOf(int projectors) {
  int rows = 1;
  for (int i = 2; i * i <= projectors; ++i) rows = projectors % i == 0 ? i : rows;
  return {projectors / rows, rows};
}

/// Runs in a process of its own, so that neither memory nor threads carry over. Throws when it fails.
template <class Work>
void apart(Work work) {
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    int status = 1;
    try {
      work();
      status = 0;
    } catch (const std::exception& error) {
      fmt::print(stderr, "calibrate_bench: {}\n", error.what());
    }
    std::fflush(stdout);
    _exit(status);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0) throw std::runtime_error("a part of the benchmark failed");
}

void photograph(int projectors, bool tiny, const fs::path& folder) {
  const Layout layout = layoutOf(projectors);
  SimulatedWall room(tiny ? miniRig(2) : casualRig(layout.columns, layout.rows, {1024, 768}, 8));
  (void)calibrateRig(room, folder);
}

void solve(int projectors, const fs::path& folder) {
  const Wall wall = loadWall(folder);
  FolderPhotographs photographs({folder / "captures"}, folder / "captures");
  TimedProgress progress;
  const auto begin = Clock::now();
  Procedure procedure(folder, wall, {}, &photographs, progress);
  procedure.run({.force = true, .goOnWithoutFailed = true});
  procedure.save();
  const double seconds = secondsSince(begin);
  const devices::Size camera = procedure.calibration().camera.value().size;
  double load = 0;
  getloadavg(&load, 1);
  fmt::print(
      "{{\"benchmark\": \"calibrate\", \"projectors\": {}, \"calibrated\": {}, \"photographs\": {}, \"camera\": [{}, "
      "{}], "
      "\"seconds\": {:.3f}, \"peak_mb\": {:.0f}, \"load\": {:.1f}, \"steps\": {{{}}}}}\n",
      projectors, procedure.calibration().projectors.size(), projectors * kPatternCount, camera.width, camera.height,
      seconds, peakMegabytes(), load, progress.steps());
  if (procedure.calibration().projectors.size() != static_cast<std::size_t>(projectors)) {
    throw std::runtime_error("not every projector was calibrated");
  }
}

void run(int projectors, bool tiny) {
  const testing::TemporaryFolder folder;
  apart([&] { photograph(projectors, tiny, folder.path()); });
  apart([&] { solve(projectors, folder.path()); });
}

}  // namespace
}  // namespace pixelflex::calib

int main(int argc, char** argv) {
  CLI::App app("Calibrates simulated walls from photographs on disk and prints time and memory as JSON lines");
  std::vector<int> projectors = {2, 8, 32};
  bool tiny = false;
  app.add_option("--projectors", projectors, "How many, by commas")->delimiter(',')->check(CLI::PositiveNumber);
  app.add_flag("--tiny", tiny, "Two small projectors and a small camera, to see that this works");
  CLI11_PARSE(app, argc, argv);
  if (tiny) projectors = {2};
  try {
    for (const int count : projectors) pixelflex::calib::run(count, tiny);
  } catch (const std::exception& error) {
    fmt::print(stderr, "calibrate_bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
