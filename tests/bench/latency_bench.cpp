// How long after an X client draws its pixels are in a projector's frame, beside Debian's TigerVNC viewer: one Xvnc,
// one client, the viewers in turns. A line of JSON for each.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include "calib/store/store.h"
#include "devices/display/gl_context.h"
#include "tests/bench/marks.h"
#include "tests/bench/watched_screen.h"
#include "tests/support/process.h"
#include "viewer/programs/wall_view.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kPatience = 60s;
constexpr auto kGlance = 50us;  // between two looks at a screen

struct Options {
  devices::Size desktop{1920, 1080};
  int rounds = 6;
  int updates = 240;  // of each viewer in each round
  double rate = 30;   // updates a second
  std::vector<std::string> viewers{"tigervnc", "window", "headless", "direct-window", "direct"};
};

std::string textOf(devices::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

/// A flat wall of one screen of the desktop's size, at the corner of `display`.
void makeWall(const std::string& wall, devices::Size desktop, const std::string& display) {
  const Output made = run({PIXELFLEX_BIN_DIR "/pixelflex-new", wall, "--flat", textOf(desktop)});
  if (made.status != 0) throw std::runtime_error(made.text);
  calib::Wall flat = calib::loadWall(wall);
  flat.projectors.front().output = {.kind = calib::OutputKind::kDisplay, .display = display, .at = {0, 0}};
  calib::saveWall(wall, flat);
}

/// Whoever looks at what a viewer shows, on a thread of its own, until this goes.
class Watch {
 public:
  virtual ~Watch() = default;
};

/// A viewer in a window on the watched screen.
class WindowWatch : public Watch {
 public:
  WindowWatch(WatchedScreen& screen, Marks& marks, const std::vector<std::string>& command)
      : viewer_(command, {.environment = {"DISPLAY=" + screen.x().display(), "LIBGL_ALWAYS_SOFTWARE=1"}}) {
    const glm::ivec2 shift = find(screen, marks);
    thread_ = std::jthread([&screen, &marks, shift](const std::stop_token& stop) {
      for (; !stop.stop_requested(); std::this_thread::sleep_for(kGlance)) {
        marks.look([&](glm::ivec2 at) { return screen.pixel(at + shift); });
      }
    });
  }

 private:
  /// Draws until the viewer shows it; where the desktop's corner is on the screen.
  static glm::ivec2 find(const WatchedScreen& screen, Marks& marks) {
    const auto deadline = Clock::now() + kPatience;
    while (Clock::now() < deadline) {
      marks.draw();
      std::this_thread::sleep_for(200ms);
      if (const auto found = screen.find(marks.lastColour())) return *found - marks.lastPlace();
    }
    throw std::runtime_error("the viewer's window does not show what is drawn");
  }

  Process viewer_;
  std::jthread thread_;
};

/// The headless viewer's loop, in this process: its frame is looked at each time it has drawn.
class HeadlessWatch : public Watch {
 public:
  HeadlessWatch(const viewer::ViewOptions& options, Marks& marks)
      : thread_([this, options, &marks](const std::stop_token& stop) { view(options, marks, stop); }) {
    const auto deadline = Clock::now() + kPatience;
    while (!ready_ && Clock::now() < deadline) std::this_thread::sleep_for(10ms);
    if (!ready_) throw std::runtime_error("the headless viewer shows nothing");
  }
  ~HeadlessWatch() override {
    thread_.request_stop();
    wake();
  }

 private:
  void wake() {
    const std::lock_guard lock(mutex_);
    woken_ = true;
    changed_.notify_one();
  }
  void view(const viewer::ViewOptions& options, Marks& marks, const std::stop_token& stop) {
    const std::string& folder = options.wall;
    const viewer::WallPlan wall(folder, calib::loadWall(folder), calib::loadCalibration(folder), {}, options.fit);
    devices::HeadlessContext context;
    viewer::WallView view(options, wall, viewer::expectPlans(wall), context, [this] { wake(); });
    while (!stop.stop_requested()) {
      const auto step = view.step();
      view.shown();
      ready_ = ready_ || view.hasPicture();
      if (!step.drawn.empty() && view.hasPicture()) look(view.renderer().outputTexture(0), marks);
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return woken_; });
      woken_ = false;
    }
  }
  static void look(devices::GlName frame, Marks& marks) {
    marks.look([frame](glm::ivec2 at) {
      std::array<std::uint8_t, 4> pixel{};
      glGetTextureSubImage(frame, 0, at.x, at.y, 0, 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, 4, pixel.data());
      return static_cast<std::uint32_t>(pixel[0] << 16 | pixel[1] << 8 | pixel[2]);
    });
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool woken_ = false;
  std::atomic<bool> ready_ = false;
  std::jthread thread_;
};

/// One server and client, and the viewers by name.
class Course {
 public:
  explicit Course(const Options& options) : options_(options) {
    makeWall(wall_, options.desktop, screen_.x().display());
    server_.x().query({"xsetroot", "-solid", "#203040"});
  }

  /// Milliseconds for each update; the first second does not count.
  std::vector<double> run(const std::string& viewer) {
    const auto watch = start(viewer);
    const int warmUp = static_cast<int>(options_.rate);
    draw(warmUp);
    (void)marks_.take();
    draw(options_.updates);
    auto times = marks_.take();
    lost_[viewer] += options_.updates - static_cast<int>(times.size());
    return times;
  }
  [[nodiscard]] int lost(const std::string& viewer) { return lost_[viewer]; }

 private:
  std::unique_ptr<Watch> start(const std::string& viewer) {
    const std::string address = server_.unixAddress();
    const bool direct = viewer.starts_with("direct");
    if (viewer == "headless" || viewer == "direct") {
      viewer::ViewOptions options;
      options.wall = wall_;
      options.server = viewer::parseServerAddress(direct ? "x11:" + server_.x().display() : address);
      options.source = viewer::Source::kVnc;
      return std::make_unique<HeadlessWatch>(options, marks_);
    }
    if (viewer.ends_with("window")) {
      return std::make_unique<WindowWatch>(
          screen_, marks_,
          std::vector<std::string>{PIXELFLEX_BIN_DIR "/pixelflex-view", wall_,
                                   direct ? "x11:" + server_.x().display() : address, "--source", "vnc"});
    }
    return std::make_unique<WindowWatch>(
        screen_, marks_,
        std::vector<std::string>{"xtigervncviewer", "-AutoSelect=0", "-RemoteResize=0", "-SecurityTypes=None",
                                 "-AlertOnFatalError=0", "-ReconnectOnError=0", "-Shared", "-geometry", "+0+0",
                                 address.substr(std::string("unix:").size())});
  }
  /// At even times whatever becomes of them, and then waits until all were seen.
  void draw(int count) {
    const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / options_.rate));
    auto next = Clock::now();
    for (int i = 0; i < count; ++i) {
      std::this_thread::sleep_until(next += period);
      marks_.draw();
    }
    for (const auto deadline = Clock::now() + 2s; !marks_.allSeen() && Clock::now() < deadline;) {
      std::this_thread::sleep_for(1ms);
    }
  }

  Options options_;
  TemporaryFolder folder_;
  std::string wall_ = (folder_ / "wall").string();
  WatchedScreen screen_{{options_.desktop.width + 64, options_.desktop.height + 64}};
  XvncServer server_{{.size = options_.desktop}};
  Marks marks_{server_.x().display(), options_.desktop};
  std::map<std::string, int> lost_;
};

double quantile(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) throw std::runtime_error("a viewer showed nothing of what was drawn");
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

int measure(const Options& options) {
  Course course(options);
  std::map<std::string, std::vector<double>> times;
  for (int round = 0; round < options.rounds; ++round) {
    for (const auto& viewer : options.viewers) std::ranges::copy(course.run(viewer), std::back_inserter(times[viewer]));
  }
  for (auto& [viewer, all] : times) std::ranges::sort(all);
  for (const auto& viewer : options.viewers) {
    const auto& all = times[viewer];
    fmt::print(
        R"({{"benchmark": "latency/{}", "desktop": [{}, {}], "updates": {}, "lost": {}, "median_ms": {:.2f}, "p90_ms": {:.2f}, "p99_ms": {:.2f}, "max_ms": {:.2f})",
        viewer, options.desktop.width, options.desktop.height, all.size(), course.lost(viewer), quantile(all, 0.5),
        quantile(all, 0.9), quantile(all, 0.99), all.back());
    if (viewer != "tigervnc" && times.contains("tigervnc")) {
      const auto& theirs = times["tigervnc"];
      fmt::print(R"(, "median_ratio": {:.2f}, "p99_ratio": {:.2f})", quantile(all, 0.5) / quantile(theirs, 0.5),
                 quantile(all, 0.99) / quantile(theirs, 0.99));
    }
    fmt::print("}}\n");
  }
  return 0;
}

}  // namespace
}  // namespace pixelflex::testing

int main(int argc, char** argv) {
  using namespace pixelflex::testing;
  Options options;
  CLI::App app(
      "Milliseconds from an X client's drawing of a small box to its pixels in a projector's frame (headless: in the "
      "viewer's frame; window: on the X screen; direct: of the X server itself, without VNC), and to the window of "
      "Debian's TigerVNC viewer. ratio: ours over "
      "theirs.");
  app.add_option("--width", options.desktop.width)->check(CLI::Range(640, 16384));
  app.add_option("--height", options.desktop.height)->check(CLI::Range(480, 16384));
  app.add_option("--rounds", options.rounds)->check(CLI::Range(1, 1000));
  app.add_option("--updates", options.updates, "of each viewer in each round")->check(CLI::Range(1, 100000));
  app.add_option("--rate", options.rate, "updates a second")->check(CLI::Range(0.1, 1000.0));
  app.add_option("--viewers", options.viewers)
      ->delimiter(',')
      ->check(CLI::IsMember({"tigervnc", "window", "headless", "direct-window", "direct"}));
  CLI11_PARSE(app, argc, argv);
  ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  try {
    return measure(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "latency_bench: {}\n", error.what());
    return 1;
  }
}
