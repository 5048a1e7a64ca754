// How long after a killed VNC server takes connections again the desktop is back on the wall: the whole viewer,
// headless, with a client that draws on the server. Prints a line of JSON.
#include <fmt/format.h>
#include <sys/socket.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <exception>
#include <future>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/viewer_run.h"
#include "tests/support/free_port.h"
#include "tests/support/x_servers.h"
#include "viewer/vnc/connector.h"

namespace pixelflex::testing {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr devices::Size kDesktop{1920, 1080};
constexpr std::chrono::seconds kPatience{60};

struct Run {
  int returns = 10;
  bool tcp = false;
};

/// Where the servers listen, one after the other.
class Place {
 public:
  explicit Place(bool tcp) : port_(tcp ? freePort() : 0) {}
  [[nodiscard]] std::string address() const {
    return port_ != 0 ? "127.0.0.1::" + std::to_string(port_) : "unix:" + path();
  }
  [[nodiscard]] std::unique_ptr<XvncServer> startServer() const {
    XvncOptions options{.size = kDesktop, .unixSocket = false};
    if (port_ != 0) {
      options.more = {"-rfbport", std::to_string(port_), "-localhost"};
    } else {
      options.more = {"-rfbunixpath", path()};
    }
    auto server = std::make_unique<XvncServer>(options);
    server->x().start({"bash", "-c", "while true; do xsetroot -mod $((RANDOM % 14 + 2)) 16 -fg red; done"});
    return server;
  }
  /// When the first byte of a server comes.
  [[nodiscard]] Clock::time_point waitForServer() const {
    const auto deadline = Clock::now() + kPatience;
    const viewer::Signal never;
    while (Clock::now() < deadline) {
      try {
        const auto socket = viewer::connectToServer(viewer::parseServerAddress(address()), {}, never);
        char first = 0;
        if (::recv(socket.get(), &first, 1, 0) == 1) return Clock::now();
      } catch (const std::runtime_error&) {
        std::this_thread::sleep_for(milliseconds(1));
      }
    }
    throw std::runtime_error("the server does not come back");
  }

 private:
  [[nodiscard]] std::string path() const { return (folder_ / "vnc.sock").string(); }
  TemporaryFolder folder_;
  int port_;
};

void waitForLines(const ViewerRun& viewer, const std::string& words, int count) {
  const auto deadline = Clock::now() + kPatience;
  while (Clock::now() < deadline) {
    const std::string log = viewer.log();
    int found = 0;
    for (auto at = log.find(words); at != std::string::npos; at = log.find(words, at + 1)) ++found;
    if (found >= count) return;
    std::this_thread::sleep_for(milliseconds(1));
  }
  throw std::runtime_error("the viewer never said '" + words + "' but: " + viewer.log());
}

/// Kills the server and brings another one up after a while; seconds from there until the desktop is back.
double secondsUntilBack(const Place& place, std::unique_ptr<XvncServer>& server, const ViewerRun& viewer, int turn,
                        milliseconds away) {
  server->x().process().signal(SIGKILL);
  server->x().process().wait(kPatience);
  waitForLines(viewer, "waiting for it to return", turn);
  std::this_thread::sleep_for(away);
  auto returned = std::async(std::launch::async, [&place] { return place.waitForServer(); });
  auto back = std::async(std::launch::async, [&] {
    waitForLines(viewer, "the desktop is there after", turn);
    return Clock::now();
  });
  server = place.startServer();
  return std::chrono::duration<double>(back.get() - returned.get()).count();
}

int measure(const Run& run) {
  const Place place(run.tcp);
  auto server = place.startServer();
  ViewerRun viewer(kDesktop, place.address(), {"--stats"});
  waitForLines(viewer, "stats:", 1);
  std::mt19937 random(1);
  std::uniform_int_distribution<int> away(0, 4000);
  std::vector<double> seconds;
  Held begin;
  for (int turn = 1; turn <= run.returns; ++turn) {
    seconds.push_back(secondsUntilBack(place, server, viewer, turn, milliseconds(away(random))));
    if (turn <= 2) begin = viewer.held();
  }
  waitForLines(viewer, "stats:", run.returns + 1);
  const Held end = viewer.held();
  viewer.process().signal(SIGTERM);
  if (viewer.process().wait(kPatience) != 0) throw std::runtime_error("the viewer did not end well: " + viewer.log());
  std::ranges::sort(seconds);
  fmt::print(
      "{{\"benchmark\": \"reconnect\", \"transport\": \"{}\", \"returns\": {}, \"median_s\": {:.3f}, "
      "\"max_s\": {:.3f}, \"resident_mb\": [{:.1f}, {:.1f}], \"descriptors\": [{}, {}]}}\n",
      run.tcp ? "tcp" : "unix", run.returns, seconds[seconds.size() / 2], seconds.back(), begin.megabytes,
      end.megabytes, begin.descriptors, end.descriptors);
  return 0;
}

}  // namespace
}  // namespace pixelflex::testing

int main(int argc, char** argv) {
  pixelflex::testing::Run run;
  CLI::App app{"How long after a killed server's return its desktop is back on the wall.", "reconnect_bench"};
  app.add_option("--returns", run.returns, "how often the server is killed")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--tcp", run.tcp, "over TCP instead of a UNIX socket");
  CLI11_PARSE(app, argc, argv);
  try {
    return pixelflex::testing::measure(run);
  } catch (const std::exception& error) {
    fmt::print(stderr, "reconnect_bench: {}\n", error.what());
    return 1;
  }
}
