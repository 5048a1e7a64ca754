#include "tests/bench/measured_viewer.h"

#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <utility>

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kPatience = 120s;

std::string textOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> commandOf(const std::string& wall, const std::string& server, const std::string& stats,
                                   const std::vector<std::string>& more) {
  std::vector<std::string> command{
      PIXELFLEX_BIN_DIR "/pixelflex-view", wall, server, "--source", "vnc", "--stats-json", stats};
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

/// The number behind the last of these names.
double lastNumber(const std::string& json, const std::string& name) {
  const auto at = json.rfind("\"" + name + "\":");
  return at == std::string::npos ? 0 : std::stod(json.substr(at + name.size() + 3));
}

}  // namespace

MeasuredViewer::MeasuredViewer(const std::string& wall, const std::string& server, const std::vector<std::string>& more)
    : begun_(Clock::now()),
      process_(commandOf(wall, server, (folder_ / "stats").string(), more),
               {.environment = {"LIBGL_ALWAYS_SOFTWARE=1"}, .log = folder_ / "log"}) {}

double MeasuredViewer::waitForPicture() {
  waitUntil(
      [this] {
        if (!process_.running()) throw std::runtime_error("the viewer has ended: " + textOf(folder_ / "log"));
        return textOf(folder_ / "stats").find("first_picture") != std::string::npos;
      },
      "the first picture");
  return std::chrono::duration<double>(Clock::now() - begun_).count();
}

void MeasuredViewer::waitForRest() const {
  double before = -1;
  waitUntil(
      [this, &before] {
        std::this_thread::sleep_for(300ms);
        const double now = times().all();
        return now - std::exchange(before, now) < 0.002;
      },
      "the viewer's rest");
}

double MeasuredViewer::memory(const std::string& name) const {
  const std::string status = textOf("/proc/" + std::to_string(process_.pid()) + "/status");
  return std::stod(status.substr(status.find(name + ":") + name.size() + 1)) / 1024;
}

DrawnWork MeasuredViewer::end() {
  process_.signal(SIGTERM);
  if (!process_.wait(20s)) throw std::runtime_error("the viewer does not end");
  const std::string told = textOf(folder_ / "stats");
  return {lastNumber(told, "outputs_drawn"), lastNumber(told, "pixels_drawn")};
}

void waitUntil(const std::function<bool()>& done, const std::string& what) {
  for (const auto deadline = Clock::now() + kPatience; !done(); std::this_thread::sleep_for(1ms)) {
    if (Clock::now() > deadline) throw std::runtime_error("in vain waited for " + what);
  }
}

}  // namespace pixelflex::testing
