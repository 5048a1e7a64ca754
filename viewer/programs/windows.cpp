#include "viewer/programs/windows.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <numeric>

#include "devices/display/event_loop.h"
#include "devices/display/monitors.h"
#include "devices/display/window.h"
#include "viewer/programs/headless.h"
#include "viewer/programs/input.h"
#include "viewer/programs/quit_signal.h"
#include "viewer/programs/room_of_rig.h"
#include "viewer/programs/stats_printer.h"
#include "viewer/programs/wall_view.h"
#include "viewer/x11/x_display.h"

namespace pixelflex::viewer {
namespace {

const calib::ProjectorConfig& configOf(const WallPlan& wall, const std::string& name) {
  const auto& all = wall.wall().projectors;
  const auto found = std::ranges::find(all, name, &calib::ProjectorConfig::name);
  if (found == all.end()) throw ViewError("wall.yaml has no projector " + name + " any more: calibrate again");
  return *found;
}

/// All windows of a process are on one display: the one that the outputs name, else $DISPLAY.
std::optional<std::string> chooseDisplay(const WallPlan& wall) {
  std::optional<std::string> chosen;
  for (const auto* projector : wall.projectors()) {
    const auto& output = configOf(wall, projector->name).output;
    if (output.kind != calib::OutputKind::kDisplay) continue;
    if (chosen && chosen != output.display) {
      throw ViewError("the projectors are on displays " + *chosen + " and " + output.display +
                      ": start one viewer for each, with --projectors");
    }
    chosen = output.display;
  }
  return chosen;
}

/// A desktop that shows itself would never come to rest.
std::optional<std::string> requireAnother(const ViewOptions& options, std::optional<std::string> display) {
  const char* usual = std::getenv("DISPLAY");
  const std::string windows = display.value_or(usual == nullptr ? "" : usual);
  const bool local = windows.starts_with(':') && options.server.isXDisplay();
  if (local && parseXDisplay(windows) == parseXDisplay(options.server.xDisplay)) {
    throw ViewError("the windows would be on " + windows +
                    ", which they show: give the projectors another display in wall.yaml, or use --headless");
  }
  return display;
}

/// The options with a depth that the display's windows can show.
ViewOptions atDepthOf(devices::Window& window, const ViewOptions& options) {
  ViewOptions possible = options;
  if (options.depth <= window.bitsPerColour()) return possible;
  fmt::print(stderr, "pixelflex-view: warning: windows on this display have {} bits for each colour, so 8 are sent\n",
             window.bitsPerColour());
  possible.depth = 8;
  return possible;
}

/// The windows of a wall and what they show. Main thread.
class WallWindows {
 public:
  WallWindows(const ViewOptions& options, const WallPlan& wall)
      : wall_(wall),
        loop_(requireAnother(options, chooseDisplay(wall))),
        hidden_(loop_, {.title = "PixelFlex", .size = {16, 16}, .visible = false, .bitsPerColour = options.depth}),
        options_(atDepthOf(hidden_, options)),
        view_(options_, wall, hidden_, [this] { loop_.wake(); }),
        input_(view_, [this] { quit_ = true; }) {
    for (std::size_t i = 0; i < wall.projectors().size(); ++i) open(i);
    if (!simulated_.empty()) openRoom();
    if (windows_.empty()) {
      throw ViewError(
          "no projector of this wall has an output: give output: {monitor: NAME} in wall.yaml, or use --headless");
    }
  }

  int run(const QuitSignal& signal) {
    StatsPrinter stats(options_.stats);
    while (!quit_ && !signal.raised()) {
      const auto step = view_.step();
      if (step.plansChanged) roomChanged_ = allSimulated();
      for (const std::size_t output : step.drawn) present(output);
      presentRoom();
      stats.printIfDue(view_);
      if (screenshotDone()) break;
      wait(stats.due());
    }
    stats.printTotal(view_);
    return 0;
  }

 private:
  struct OutputWindow {
    std::size_t output = 0;
    std::unique_ptr<devices::Window> window;
  };

  void open(std::size_t index) {
    const auto& projector = *wall_.projectors()[index];
    const auto& output = configOf(wall_, projector.name).output;
    if (output.kind == calib::OutputKind::kNone) return;
    if (output.kind == calib::OutputKind::kSim) {
      simulated_.push_back(index);
      return;
    }
    devices::WindowRequest request{.title = "PixelFlex " + projector.name,
                                   .size = projector.resolution,
                                   .at = output.at,
                                   .borderless = true,
                                   .paced = windows_.empty(),
                                   .showPointer = false,
                                   .bitsPerColour = options_.depth};
    if (output.kind == calib::OutputKind::kMonitor) {
      const auto monitor = devices::findMonitor(loop_, output.monitor);
      if (monitor.size != projector.resolution) {
        fmt::print(stderr, "pixelflex-view: warning: monitor {} is set to {}x{}, projector {} to {}x{}\n",
                   output.monitor, monitor.size.width, monitor.size.height, projector.name, projector.resolution.width,
                   projector.resolution.height);
      }
      request.at = monitor.position;
    }
    auto window = std::make_unique<devices::Window>(loop_, request, &hidden_);
    window->setHandlers(input_.handlers(
        [this, index](glm::dvec2 p) {
          return view_.pointerMap() != nullptr ? view_.pointerMap()->fromProjector(index, p) : std::nullopt;
        },
        [this, index] { present(index); }));
    windows_.push_back({index, std::move(window)});
  }

  void openRoom() {
    std::vector<std::string> names;
    for (const std::size_t index : simulated_) names.push_back(wall_.projectors()[index]->name);
    if (!wall_.wall().rig) throw ViewError("output: sim needs rig: FILE in wall.yaml");
    const RoomOfRig rig = roomOfRig(std::filesystem::path(options_.wall) / *wall_.wall().rig, names);
    framing_.topLeft = rig.topLeft;
    framing_.bottomRight = rig.bottomRight;
    const glm::dvec2 extent = rig.bottomRight - rig.topLeft;
    constexpr int kWidth = 1400;
    const int height = std::clamp(static_cast<int>(kWidth * extent.y / extent.x), 200, 1400);
    roomWindow_ = std::make_unique<devices::Window>(
        loop_, devices::WindowRequest{.title = "PixelFlex: the room", .size = {kWidth, height}}, &hidden_);
    room_.emplace(hidden_, rig.projectors);
    roomWindow_->setHandlers(input_.handlers(
        [this](glm::dvec2 p) -> std::optional<glm::ivec2> {
          if (view_.pointerMap() == nullptr || framing_.picture.area() == 0) return std::nullopt;
          return view_.pointerMap()->fromWall(framing_.wallFromPicture(p));
        },
        [this] { roomChanged_ = allSimulated(); }));
    windows_.push_back({simulated_.front(), nullptr});
    roomChanged_ = allSimulated();
  }

  [[nodiscard]] std::vector<std::size_t> allSimulated() const {
    std::vector<std::size_t> all(simulated_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
  }

  void present(std::size_t output) {
    for (const auto& [shown, window] : windows_) {
      if (window == nullptr || shown != output || output >= view_.renderer().outputCount()) continue;
      window->present(view_.renderer().outputTexture(output), view_.renderer().outputResolution(output));
    }
    if (const auto found = std::ranges::find(simulated_, output); found != simulated_.end()) {
      roomChanged_.push_back(static_cast<std::size_t>(found - simulated_.begin()));
    }
  }

  void presentRoom() {
    if (!room_ || roomChanged_.empty() || view_.renderer().outputCount() == 0) return;
    std::vector<devices::GlName> frames;
    for (const std::size_t index : simulated_) frames.push_back(view_.renderer().outputTexture(index));
    framing_.picture = roomWindow_->size();
    if (framing_.picture.area() == 0) return;  // minimised
    room_->draw(frames, roomChanged_, framing_);
    roomChanged_.clear();
    roomWindow_->present(room_->texture(), framing_.picture);
  }

  bool screenshotDone() {
    if (!options_.screenshot || !view_.hasPicture()) return false;
    if (WallView::Clock::now() < view_.lastChange() + options_.settle) return false;
    writeScreenshot(*options_.screenshot, view_.renderer(), options_.depth);
    return true;
  }

  void wait(WallView::Clock::time_point deadline) {
    if (options_.screenshot && view_.hasPicture()) deadline = std::min(deadline, view_.lastChange() + options_.settle);
    if (deadline == WallView::Clock::time_point::max()) {
      loop_.wait();
    } else {
      loop_.wait(deadline - WallView::Clock::now());
    }
  }

  const WallPlan& wall_;
  devices::EventLoop loop_;
  devices::Window hidden_;
  ViewOptions options_;
  WallView view_;
  Input input_;
  std::vector<OutputWindow> windows_;
  std::vector<std::size_t> simulated_;
  std::unique_ptr<devices::Window> roomWindow_;
  std::optional<RoomView> room_;
  std::vector<std::size_t> roomChanged_;  // indices into simulated_
  RoomFraming framing_;
  bool quit_ = false;
};

}  // namespace

int runWindows(const ViewOptions& options, const WallPlan& wall) {
  // The signal's thread must exist before any other, but what it wakes comes later.
  std::atomic<bool> open = false;
  const QuitSignal signal([&open] {
    if (open) devices::EventLoop::wake();
  });
  WallWindows windows(options, wall);
  open = true;
  const int status = windows.run(signal);
  open = false;
  return status;
}

}  // namespace pixelflex::viewer
