// A day at the wall, compressed: hundreds of thousands of changes of all kinds, the desktop's size changing in between,
// from a server in this process to `pixelflex view --headless`. Prints a line of JSON; fails when the picture is not
// exact at the end.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <exception>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "devices/image/png_file.h"
#include "tests/bench/busy_desktop.h"
#include "tests/bench/viewer_run.h"

namespace pixelflex::testing {
namespace {

using Clock = std::chrono::steady_clock;

constexpr devices::Size kScreen{640, 480};
constexpr std::array<devices::Size, 5> kSizes{{{800, 600}, {320, 200}, {1024, 768}, {511, 513}, kScreen}};
// As long as nothing changes for this time, the viewer believes that the day is over.
constexpr const char* kSettle = "5000";

struct Day {
  int updates = 200'000;
  int resizeEvery = 1000;
  double mostGrowth = 1;  // per cent of resident memory
};

double meanOf(std::span<const double> values) {
  return std::reduce(values.begin(), values.end()) / static_cast<double>(values.size());
}

void serveUntilAwaited(BusyDesktop& desktop, ViewerRun& viewer) {
  const auto deadline = Clock::now() + std::chrono::seconds(60);
  while (!desktop.isAwaited()) {
    desktop.serve();
    if (Clock::now() > deadline) throw std::runtime_error("the viewer asks for nothing: " + viewer.log());
  }
}

/// The viewer's memory at the end of each stretch between two changes of size.
std::vector<double> pushUpdates(const Day& day, BusyDesktop& desktop, ViewerRun& viewer) {
  std::vector<double> megabytes;
  for (int i = 1; i <= day.updates; ++i) {
    serveUntilAwaited(desktop, viewer);
    desktop.change();
    if (i % day.resizeEvery != 0) continue;
    serveUntilAwaited(desktop, viewer);
    megabytes.push_back(viewer.held().megabytes);
    desktop.resize(kSizes.at(megabytes.size() % kSizes.size()));
  }
  // Like the screen at the end, so that what the projector is sent must be the desktop bit for bit.
  desktop.resize(kScreen);
  for (int i = 0; i < 20; ++i) {
    serveUntilAwaited(desktop, viewer);
    desktop.change();
  }
  return megabytes;
}

void expectExact(const BusyDesktop& desktop, const TemporaryFolder& folder) {
  const devices::Image8 expected = desktop.picture();
  for (const auto* file : {"desktop.png", "p1.png"}) {
    if (!(devices::readPng8(folder / file) == expected)) {
      throw std::runtime_error(std::string(file) + " is not what the server holds");
    }
  }
}

/// Growth in per cent from the second tenth of the stretches to the last.
double growthOf(const std::vector<double>& megabytes) {
  const std::size_t tenth = std::max<std::size_t>(megabytes.size() / 10, kSizes.size());
  if (megabytes.size() < 3 * tenth) throw std::runtime_error("too few changes of size to tell memory's growth");
  const double begin = meanOf(std::span(megabytes).subspan(tenth, tenth));
  return 100 * (meanOf(std::span(megabytes).last(tenth)) / begin - 1);
}

int live(const Day& day) {
  const TemporaryFolder shot;
  BusyDesktop desktop(kSizes.front());
  ViewerRun viewer(kScreen, desktop.address(), {"--screenshot", shot.path().string(), "--settle", kSettle, "--stats"});
  const auto begin = Clock::now();
  const std::vector<double> megabytes = pushUpdates(day, desktop, viewer);
  const std::chrono::duration<double> seconds = Clock::now() - begin;
  while (viewer.process().running()) desktop.serve();
  if (viewer.process().wait(std::chrono::seconds(1)) != 0) throw std::runtime_error(viewer.log());
  expectExact(desktop, shot);
  const double growth = growthOf(megabytes);
  fmt::print(
      "{{\"benchmark\": \"day\", \"updates\": {}, \"resizes\": {}, \"seconds\": {:.1f}, \"resident_mb\": {:.1f}, "
      "\"growth_percent\": {:.2f}, \"exact\": true}}\n",
      day.updates, megabytes.size(), seconds.count(), megabytes.back(), growth);
  if (growth <= day.mostGrowth) return 0;
  fmt::print(stderr, "day_bench: the viewer's memory grew by more than {} %\n", day.mostGrowth);
  return 1;
}

}  // namespace
}  // namespace pixelflex::testing

int main(int argc, char** argv) {
  pixelflex::testing::Day day;
  CLI::App app{"A day of changes on the desktop, as fast as the viewer takes them.", "day_bench"};
  app.add_option("--updates", day.updates, "how many changes")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--resize-every", day.resizeEvery, "changes between two sizes")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--most-growth", day.mostGrowth, "of the viewer's memory, in per cent")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return pixelflex::testing::live(day);
  } catch (const std::exception& error) {
    fmt::print(stderr, "day_bench: {}\n", error.what());
    return 1;
  }
}
