#include "viewer/programs/model_windows.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>

#include "devices/display/event_loop.h"
#include "devices/display/monitors.h"
#include "devices/display/window.h"
#include "viewer/model/stereo_picture.h"
#include "viewer/plan/pointer_map.h"
#include "viewer/programs/model_headless.h"
#include "viewer/programs/model_navigation.h"
#include "viewer/programs/model_tracker.h"
#include "viewer/programs/quit_signal.h"
#include "viewer/programs/room_of_rig.h"

namespace pixelflex::viewer {
namespace {

const calib::Output& outputOf(const WallPlan& wall, const std::string& projector) {
  const auto& all = wall.wall().projectors;
  const auto found = std::ranges::find(all, projector, &calib::ProjectorConfig::name);
  if (found == all.end()) throw PlanError("wall.yaml has no projector " + projector + " any more: calibrate again");
  return found->output;
}

/// All windows of a process are on one display: the one that its outputs name, else $DISPLAY.
std::optional<std::string> displayOf(const WallPlan& wall) {
  std::optional<std::string> display;
  for (const auto* projector : wall.projectors()) {
    const auto& output = outputOf(wall, projector->name);
    if (output.kind != calib::OutputKind::kDisplay) continue;
    if (display && *display != output.display) {
      throw PlanError(
          "outputs on several displays: show their projectors by processes of their own, with --projectors");
    }
    display = output.display;
  }
  return display;
}

bool isWindow(calib::OutputKind kind) {
  return kind == calib::OutputKind::kMonitor || kind == calib::OutputKind::kDisplay;
}

ModelWallOptions drawingOf(const ModelCommand& command, const WallPlan& wall) {
  auto options = command.draw;
  const bool anywhere = std::ranges::any_of(wall.projectors(), [&](const auto* projector) {
    return outputOf(wall, projector->name).kind != calib::OutputKind::kNone;
  });
  options.desktop = command.preview || command.stereo != StereoKind::kOff || !anywhere;
  options.bothEyes = command.stereo != StereoKind::kOff;
  return options;
}

/// A window, what it shows and how places in it become places of the desktop.
struct Shown {
  std::unique_ptr<devices::Window> window;
  std::function<void(devices::Window&)> present;
  std::function<std::optional<glm::dvec2>(const devices::Window&, glm::dvec2)> desktopFromWindow;
};

class ModelWindows {
 public:
  ModelWindows(const ModelCommand& command, const WallPlan& wall, Scene scene)
      : command_(command),
        wall_(wall),
        loop_(displayOf(wall)),
        hidden_(loop_, {.title = "PixelFlex", .size = {16, 16}, .visible = false}),
        model_(hidden_, wall, command.wall, drawingOf(command, wall)),
        view_(viewOf(command, windowOf(wall.display()))),
        navigation_(command.pose, command.wireframe, command.axes, command.cut,
                    std::min(wall.desktop().width, wall.desktop().height)),
        pointers_(wall, wall.desktop()) {
    model_.setScene(std::move(scene));
    printFits(command, wall, model_);
    for (std::size_t i = 0; i < wall.projectors().size(); ++i) openProjector(i);
    openRoom();
    if (drawingOf(command, wall).desktop) openPreview();
    if (command.track) loop_.addTask(&tracker_, tracker_.descriptor(), [this] { follow(); });
    // What the loop reads is drawn at once.
    fmt::print("showing {} windows; Escape ends\n", windows_.size());
    std::fflush(stdout);
  }
  ~ModelWindows() { loop_.removeTask(&tracker_); }
  ModelWindows(const ModelWindows&) = delete;
  ModelWindows& operator=(const ModelWindows&) = delete;

  int run(const QuitSignal& signal) {
    while (!quit_ && !navigation_.quit() && !signal.raised()) {
      if (navigation_.apply(view_) || moved_) model_.setView(view_);
      moved_ = false;
      if (model_.draw()) presentAll();
      loop_.wait();
      if (tracker_.ended()) loop_.removeTask(&tracker_);
    }
    return 0;
  }

 private:
  void follow() {
    const auto eye = tracker_.read();
    if (!eye) return;
    view_.viewer.eye = *eye;
    moved_ = true;
  }

  void add(Shown shown) {
    windows_.push_back(std::move(shown));
    const std::size_t number = windows_.size() - 1;
    devices::WindowHandlers handlers;
    handlers.pointer = [this, number](glm::dvec2 p) {
      auto& from = windows_[number];
      if (const auto there = from.desktopFromWindow(*from.window, p)) navigation_.pointer(*there);
    };
    handlers.button = [this](int button, bool pressed) { navigation_.button(button, pressed); };
    handlers.scroll = [this](glm::dvec2 steps) { navigation_.scroll(steps.y); };
    handlers.key = [this](const devices::KeyStroke& stroke) { navigation_.key(stroke); };
    handlers.close = [this] { quit_ = true; };
    handlers.redraw = [this, number] { present(windows_[number]); };
    windows_[number].window->setHandlers(std::move(handlers));
  }

  void openProjector(std::size_t index) {
    const auto& projector = *wall_.projectors()[index];
    const auto& output = outputOf(wall_, projector.name);
    if (!isWindow(output.kind)) return;
    const glm::ivec2 at =
        output.kind == calib::OutputKind::kMonitor ? devices::findMonitor(loop_, output.monitor).position : output.at;
    auto window = std::make_unique<devices::Window>(
        loop_,
        devices::WindowRequest{
            .title = "PixelFlex " + projector.name, .size = projector.resolution, .at = at, .borderless = true},
        &hidden_);
    add({std::move(window),
         [this, index](devices::Window& to) { to.present(model_.texture(index), model_.resolution(index)); },
         [this, index](const devices::Window&, glm::dvec2 p) -> std::optional<glm::dvec2> {
           const auto there = pointers_.fromProjector(index, p);
           return there ? std::optional(glm::dvec2(*there)) : std::nullopt;
         }});
  }

  void openPreview() {
    const auto [width, height] = wall_.desktop();
    constexpr int kWidth = 1200;
    const int rows = std::clamp(static_cast<int>(std::int64_t{kWidth} * height / width), 100, 1000);
    auto window = std::make_unique<devices::Window>(
        loop_, devices::WindowRequest{.title = "PixelFlex: the model", .size = {kWidth, rows}}, &hidden_);
    if (command_.stereo != StereoKind::kOff) stereo_.emplace(hidden_, wall_.desktop());
    add({std::move(window), [this](devices::Window& to) { to.present(desktopTexture(), wall_.desktop()); },
         [this](const devices::Window& from, glm::dvec2 p) -> std::optional<glm::dvec2> {
           const glm::dvec2 size(from.size().width, from.size().height);
           return p / glm::max(size, 1.0) * glm::dvec2(wall_.desktop().width, wall_.desktop().height);
         }});
  }

  [[nodiscard]] devices::GlName desktopTexture() {
    if (!stereo_) return model_.desktopTexture(model_.desktopCount() - 1);
    return stereo_->texture();
  }

  void openRoom() {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < wall_.projectors().size(); ++i) {
      if (outputOf(wall_, wall_.projectors()[i]->name).kind != calib::OutputKind::kSim) continue;
      simulated_.push_back(i);
      names.push_back(wall_.projectors()[i]->name);
    }
    if (names.empty()) return;
    if (!wall_.wall().rig) throw PlanError("output: sim needs rig: FILE in wall.yaml");
    const RoomOfRig rig = roomOfRig(std::filesystem::path(command_.wall) / *wall_.wall().rig, names);
    framing_.topLeft = rig.topLeft;
    framing_.bottomRight = rig.bottomRight;
    const glm::dvec2 extent = rig.bottomRight - rig.topLeft;
    constexpr int kWidth = 1400;
    const int rows = std::clamp(static_cast<int>(kWidth * extent.y / extent.x), 200, 1400);
    auto window = std::make_unique<devices::Window>(
        loop_, devices::WindowRequest{.title = "PixelFlex: the room", .size = {kWidth, rows}}, &hidden_);
    room_.emplace(hidden_, rig.projectors);
    add({std::move(window), [this](devices::Window& to) { presentRoom(to); },
         [this](const devices::Window&, glm::dvec2 p) -> std::optional<glm::dvec2> {
           if (framing_.picture.area() == 0) return std::nullopt;
           return glm::dvec2(pointers_.fromWall(framing_.wallFromPicture(p)));
         }});
  }

  void presentRoom(devices::Window& window) {
    framing_.picture = window.size();
    if (framing_.picture.area() == 0) return;  // minimised
    std::vector<devices::GlName> frames;
    for (const std::size_t index : simulated_) frames.push_back(model_.texture(index));
    std::vector<std::size_t> all(simulated_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    room_->draw(frames, all, framing_);
    window.present(room_->texture(), framing_.picture);
  }

  void presentAll() {
    if (stereo_) stereo_->draw(model_.desktopTexture(0), model_.desktopTexture(1), command_.stereo);
    for (auto& shown : windows_) present(shown);
  }

  /// Not before there is anything to show.
  void present(Shown& shown) {
    if (!model_.drawn()) return;
    shown.present(*shown.window);
  }

  const ModelCommand& command_;
  const WallPlan& wall_;
  devices::EventLoop loop_;
  devices::Window hidden_;
  ModelWall model_;
  ModelView view_;
  ModelNavigation navigation_;
  PointerMap pointers_;
  ModelTracker tracker_{STDIN_FILENO};
  std::optional<StereoPicture> stereo_;
  std::optional<RoomView> room_;
  RoomFraming framing_;
  std::vector<std::size_t> simulated_;
  std::vector<Shown> windows_;
  bool moved_ = false;
  bool quit_ = false;
};

}  // namespace

int runModelWindows(const ModelCommand& command, const WallPlan& wall, Scene scene) {
  // The signal's thread must exist before any other, but what it wakes comes later.
  std::atomic<bool> open = false;
  const QuitSignal signal([&open] {
    if (open) devices::EventLoop::wake();
  });
  ModelWindows windows(command, wall, std::move(scene));
  open = true;
  const int status = windows.run(signal);
  open = false;
  return status;
}

}  // namespace pixelflex::viewer
