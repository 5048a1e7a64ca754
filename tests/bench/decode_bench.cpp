// How fast the session takes what servers send, beside Debian's TigerVNC viewer fed the same bytes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <map>
#include <memory>
#include <thread>

#include "tests/bench/replay_server.h"
#include "tests/bench/rfb_recording.h"
#include "tests/support/x_servers.h"
#include "viewer/vnc/session.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using Seconds = std::chrono::duration<double>;

struct Options {
  devices::Size desktop{3840, 2160};
  double record = 4;  // seconds of each scene
  int passes = 7;
  std::vector<std::string> scenes{"photographs", "terminal", "mixed", "video"};
  bool peer = true;
};

RfbRecording recordScene(const std::string& scene, const Options& options) {
  const std::string folder = "/usr/share/doc/opencv-doc/examples/data";
  XvncServer server({.size = options.desktop, .more = {"-FrameRate=60"}});
  const auto client = [&](const char* what) { server.x().start({PIXELFLEX_SCENE_CLIENT, what, folder}); };
  const auto terminal = [&](const std::string& place) {
    server.x().start({"xterm", "-geometry", place, "-e", "sh", "-c", "while :; do ls -l /usr/bin /usr/lib; done"});
  };
  if (scene == "mixed") client("drag");
  if (scene == "mixed" || scene == "video") client("video");
  if (scene == "photographs") client("photographs");
  if (scene == "terminal") terminal("250x120+40+40");
  if (scene == "mixed" || scene == "terminal") terminal("120x50-40-40");
  std::this_thread::sleep_for(1500ms);
  const std::string path = server.unixAddress().substr(std::string("unix:").size());
  return recordServer(path, std::chrono::milliseconds(std::lround(1000 * options.record)));
}

/// Our session, with somebody who takes the batches and leaves them.
class OurSide {
 public:
  explicit OurSide(ReplayServer& server) {
    viewer::SessionOptions options;
    options.server = viewer::parseServerAddress("unix:" + server.socketPath());
    options.claimPointer = false;
    session_ = std::make_unique<viewer::Session>(options, belt_, [] {});
    server.accept();
  }

 private:
  void takeAll() {
    while (viewer::Batch* batch = belt_.take()) belt_.release(batch);
  }

  viewer::FrameBelt belt_{[this] { takeAll(); }};
  std::unique_ptr<viewer::Session> session_;
};

/// The viewer's window is as large as the desktop, on an Xvfb of its own.
class TheirSide {
 public:
  TheirSide(ReplayServer& server, XServer& screen) {
    screen.start({"xtigervncviewer", "-AutoSelect=0", "-RemoteResize=0", "-SecurityTypes=None", "-AlertOnFatalError=0",
                  "-ReconnectOnError=0", "-Shared", "-geometry", "+0+0", server.socketPath()});
    server.accept();
  }
};

struct Measured {
  double median = 0, best = 0;
};

Measured measured(std::vector<double> seconds) {
  std::ranges::sort(seconds);
  return {seconds[seconds.size() / 2], seconds.front()};
}

void report(const std::string& scene, const RfbRecording& recording, const Measured& ours, const Measured& theirs) {
  const double megabytes = static_cast<double>(recording.messages.size()) / 1e6;
  fmt::print(
      R"({{"benchmark": "decode/{}", "desktop": [{}, {}], "megabytes": {:.2f}, "seconds": {:.4f}, "best": {:.4f})",
      scene, recording.desktop.width, recording.desktop.height, megabytes, ours.median, ours.best);
  if (theirs.median > 0) {
    fmt::print(R"(, "tigervnc_seconds": {:.4f}, "tigervnc_best": {:.4f}, "ratio": {:.2f})", theirs.median, theirs.best,
               theirs.median / ours.median);
  }
  fmt::print("}}\n");
  std::fflush(stdout);
}

/// Pass by pass in turns, so that whatever else the machine does meets both. The first pass warms up.
void compare(const std::string& scene, const Options& options) {
  fmt::print(stderr, "recording {}…\n", scene);
  const RfbRecording recording = recordScene(scene, options);
  ReplayServer toUs(recording);
  ReplayServer toThem(recording);
  const OurSide ours(toUs);
  (void)toUs.play();
  std::optional<XServer> screen;
  std::optional<TheirSide> theirs;
  if (options.peer) {
    const std::string size = fmt::format("{}x{}x24", options.desktop.width + 64, options.desktop.height + 64);
    screen.emplace([&](const TemporaryFolder&) { return std::vector<std::string>{"Xvfb", "-screen", "0", size}; });
    theirs.emplace(toThem, *screen);
    (void)toThem.play();
    std::this_thread::sleep_for(1s);  // until its window is there and drawn
  }
  std::vector<double> ourTimes, theirTimes;
  for (int pass = 0; pass < options.passes; ++pass) {
    ourTimes.push_back(Seconds(toUs.play()).count());
    if (theirs) theirTimes.push_back(Seconds(toThem.play()).count());
  }
  report(scene, recording, measured(ourTimes), theirs ? measured(theirTimes) : Measured{});
}

}  // namespace
}  // namespace pixelflex::testing

int main(int argc, char** argv) {
  using namespace pixelflex::testing;
  Options options;
  CLI::App app(
      "Records what Xvnc says while X clients work, and plays it to PixelFlex's session and to Debian's TigerVNC "
      "viewer in turns. A line of JSON for each scene; ratio: their time over ours.");
  app.add_option("--width", options.desktop.width)->check(CLI::Range(640, 16384));
  app.add_option("--height", options.desktop.height)->check(CLI::Range(480, 16384));
  app.add_option("--record", options.record, "seconds of each scene")->check(CLI::Range(0.2, 60.0));
  app.add_option("--passes", options.passes)->check(CLI::Range(1, 1000));
  app.add_option("--scenes", options.scenes)
      ->delimiter(',')
      ->check(CLI::IsMember({"photographs", "terminal", "mixed", "video"}));
  app.add_flag("--peer,!--no-peer", options.peer, "TigerVNC's viewer as well");
  CLI11_PARSE(app, argc, argv);
  try {
    for (const auto& scene : options.scenes) compare(scene, options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "decode_bench: {}\n", error.what());
    return 1;
  }
}
