#include "viewer/programs/windows.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <glm/common.hpp>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "devices/display/clipboard.h"
#include "devices/display/display_watch.h"
#include "devices/display/event_loop.h"
#include "devices/display/monitors.h"
#include "devices/display/window.h"
#include "viewer/plan/overview.h"
#include "viewer/programs/headless.h"
#include "viewer/programs/input.h"
#include "viewer/programs/projector_windows.h"
#include "viewer/programs/quit_signal.h"
#include "viewer/programs/room_of_rig.h"
#include "viewer/programs/stats_printer.h"
#include "viewer/programs/wall_view.h"
#include "viewer/x11/x_display.h"

namespace pixelflex::viewer {
namespace {

/// All windows of a process are on one display: the one that its outputs name, else $DISPLAY.
std::optional<std::string> chooseDisplay(const WallPlan& wall) {
  for (const auto* projector : wall.projectors()) {
    const auto& output = configOf(wall, projector->name).output;
    if (output.kind == calib::OutputKind::kDisplay) return output.display;
  }
  return std::nullopt;
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
        plans_(expectPlans(wall)),
        loop_(requireAnother(options, chooseDisplay(wall))),
        hidden_(loop_, {.title = "PixelFlex", .size = {16, 16}, .visible = false, .bitsPerColour = options.depth}),
        options_(atDepthOf(hidden_, options)),
        view_(options_, wall, std::move(plans_), hidden_, [this] { loop_.wake(); }),
        stats_(options_),
        input_(view_, {.quit = [this] { quit_ = true; }, .stats = [this] { stats_.toggleOverlay(view_); }}),
        projectors_(loop_, hidden_, view_, input_, options_.depth),
        watch_([this] {
          monitorsChanged_ = true;
          loop_.wake();
        }) {
    openClipboard(Selection::kClipboard);
    if (options_.primary) openClipboard(Selection::kPrimary);
    for (std::size_t i = 0; i < wall.projectors().size(); ++i) {
      if (configOf(wall, wall.projectors()[i]->name).output.kind == calib::OutputKind::kSim) simulated_.push_back(i);
    }
    if (!simulated_.empty()) openRoom();
    if (options.control) openControl();
    requireWindows();
    if (locksPointer()) input_.lockPointer();
    if (options_.grab && !options_.viewOnly) input_.grabKeyboard();
  }

  int run(const QuitSignal& signal) {
    while (!quit_ && !signal.raised()) {
      stats_.printIfDue(view_);
      const auto step = view_.step();
      if (step.plansChanged) roomChanged_ = allSimulated();
      if (monitorsChanged_.exchange(false)) projectors_.follow(devices::listMonitors(loop_));
      present(step.drawn);
      presentRoom();
      view_.shown();
      stats_.shown(view_);
      for (const auto& [text, selection] : step.copied) {
        if (const auto here = clipboards_.find(selection); here != clipboards_.end()) here->second.set(text);
      }
      if (step.bell) watch_.ringBell();
      if (screenshotDone()) break;
      wait(stats_.due());
    }
    stats_.printTotal(view_);
    return 0;
  }

 private:
  void requireWindows() const {
    if (projectors_.empty() && !room_) {
      throw ViewError(
          "no projector of this wall has an output: give output: {monitor: NAME} in wall.yaml, or use --headless");
    }
    if (room_ || controlWindow_ || projectors_.anyShown()) return;
    std::string names;
    for (const auto& monitor : devices::listMonitors(loop_)) names += (names.empty() ? "" : ", ") + monitor.name;
    throw ViewError("none of the projectors' monitors is there; there are: " + (names.empty() ? "none" : names));
  }

  [[nodiscard]] bool locksPointer() const {
    if (options_.viewOnly || projectors_.empty()) return false;
    if (options_.pointer == PointerMode::kAuto) return !controlWindow_ && !projectors_.lieAsOnTheWall();
    return options_.pointer == PointerMode::kDesktop;
  }

  void openClipboard(Selection selection) {
    if (options_.clipboardLimit == 0) return;
    const auto here = selection == Selection::kPrimary ? devices::Selection::kPrimary : devices::Selection::kClipboard;
    const devices::ClipboardHandlers handlers{
        [this, selection](std::string text) { view_.copy(selection, std::move(text)); },
        [this] { view_.refuse({.onDesktop = false, .limit = options_.clipboardLimit}); }};
    clipboards_.emplace(std::piecewise_construct, std::forward_as_tuple(selection),
                        std::forward_as_tuple(here, options_.clipboardLimit, handlers));
  }

  void openControl() {
    const OutputPlan plan = overviewOf(wall_.desktop());
    controlWindow_ = std::make_unique<devices::Window>(
        loop_, devices::WindowRequest{.title = "PixelFlex: the desktop", .size = plan.resolution, .showPointer = false},
        &hidden_);
    const auto map = [this](glm::dvec2 p) -> std::optional<glm::ivec2> {
      const glm::dvec2 desktop(view_.desktop().width, view_.desktop().height);
      const glm::dvec2 window(controlWindow_->size().width, controlWindow_->size().height);
      if (desktop.x < 1 || window.x < 1 || window.y < 1) return std::nullopt;
      return glm::ivec2(glm::clamp(glm::floor(p / window * desktop), glm::dvec2(0), desktop - 1.0));
    };
    input_.take(
        *controlWindow_, map, [this] { presentControl(); }, false);
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
    input_.take(
        *roomWindow_,
        [this](glm::dvec2 p) -> std::optional<glm::ivec2> {
          if (view_.pointerMap() == nullptr || framing_.picture.area() == 0) return std::nullopt;
          return view_.pointerMap()->fromWall(framing_.wallFromPicture(p));
        },
        [this] { roomChanged_ = allSimulated(); }, false);
    roomChanged_ = allSimulated();
  }

  [[nodiscard]] std::vector<std::size_t> allSimulated() const {
    std::vector<std::size_t> all(simulated_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
  }

  void present(const std::vector<std::size_t>& outputs) {
    projectors_.present(outputs);
    for (const std::size_t output : outputs) {
      if (output == view_.controlOutput()) presentControl();
      const auto found = std::ranges::find(simulated_, output);
      if (found != simulated_.end()) roomChanged_.push_back(static_cast<std::size_t>(found - simulated_.begin()));
    }
  }

  void presentControl() {
    const std::size_t output = view_.controlOutput();
    if (!controlWindow_ || output >= view_.renderer().outputCount()) return;
    controlWindow_->present(view_.renderer().outputTexture(output), view_.renderer().outputResolution(output));
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
    deadline = std::min(deadline, view_.due());
    if (options_.screenshot && view_.hasPicture()) deadline = std::min(deadline, view_.lastChange() + options_.settle);
    if (deadline == WallView::Clock::time_point::max()) {
      loop_.wait();
    } else {
      loop_.wait(deadline - WallView::Clock::now());
    }
  }

  const WallPlan& wall_;
  ExpectedPlans plans_;  // begun before all that waits for the X server, then the view's
  devices::EventLoop loop_;
  devices::Window hidden_;
  ViewOptions options_;
  WallView view_;
  StatsPrinter stats_;
  Input input_;
  ProjectorWindows projectors_;
  std::unique_ptr<devices::Window> controlWindow_;
  std::vector<std::size_t> simulated_;
  std::unique_ptr<devices::Window> roomWindow_;
  std::optional<RoomView> room_;
  std::vector<std::size_t> roomChanged_;  // indices into simulated_
  RoomFraming framing_;
  bool quit_ = false;
  std::atomic<bool> monitorsChanged_ = false;
  devices::DisplayWatch watch_;
  std::map<Selection, devices::Clipboard> clipboards_;
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
