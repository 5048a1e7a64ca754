#include "viewer/programs/model_windows.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <optional>
#include <utility>

#include "devices/display/event_loop.h"
#include "devices/display/window.h"
#include "viewer/model/stereo_picture.h"
#include "viewer/plan/pointer_map.h"
#include "viewer/programs/model_headless.h"
#include "viewer/programs/model_navigation.h"
#include "viewer/programs/model_outputs.h"
#include "viewer/programs/model_room.h"
#include "viewer/programs/model_tracker.h"
#include "viewer/programs/quit_signal.h"
#include "viewer/programs/wall_reloader.h"

namespace pixelflex::viewer {
namespace {

ModelWallOptions drawingOf(const ModelCommand& command, const WallPlan& wall, std::vector<std::string> inHardware) {
  auto options = command.draw;
  const bool anywhere = std::ranges::any_of(wall.projectors(), [&](const auto* projector) {
    return outputOf(wall, projector->name).kind != calib::OutputKind::kNone;
  });
  options.desktop = command.preview || command.stereo != StereoKind::kOff || !anywhere;
  options.bothEyes = command.stereo != StereoKind::kOff;
  options.inHardware = std::move(inHardware);
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
  /// `keeper`: none when no output's table is used.
  ModelWindows(const ModelCommand& command, std::shared_ptr<const WallPlan> wall, Scene scene,
               devices::GammaKeeper* keeper)
      : command_(command),
        wall_(std::move(wall)),
        keeper_(keeper),
        loop_(displayOf(*wall_)),
        hidden_(loop_, {.title = "PixelFlex", .size = {16, 16}, .visible = false}),
        screens_(screensOf(*wall_, loop_)),
        options_(drawingOf(command, *wall_, lookedUpInHardware(command, *wall_, screens_, keeper))),
        model_(hidden_, *wall_, options_),
        view_(viewOf(command, windowOf(wall_->display()))),
        navigation_(command.pose, command.wireframe, command.axes, command.cut,
                    std::min(wall_->desktop().width, wall_->desktop().height)),
        pointers_(*wall_, wall_->desktop()),
        reloader_({"pixelflex-model", command.wall, command.projectors, {}, false}, *wall_,
                  [] { devices::EventLoop::wake(); }) {
    model_.setScene(std::move(scene));
    printFits(command, *wall_, model_);
    for (const auto& screen : screens_) openProjector(screen);
    openRoom();
    if (options_.desktop) openPreview();
    setTables(*wall_, screens_, options_.inHardware, keeper_);
    for (const auto& name : options_.inHardware)
      fmt::print("{}: its output's own gamma ramp looks up the codes\n", name);
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
      reload();
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
    tracked_ = true;
    moved_ = true;
  }

  /// Everything that depends on the calibration; windows stay.
  void reload() {
    const auto fresh = reloader_.take();
    if (!fresh) return;
    try {
      model_.setWall(*fresh->wall);
    } catch (const std::exception& error) {
      fmt::print(stderr, "pixelflex-model: the new calibration is not shown: {}\n", error.what());
      return;
    }
    const auto old = std::exchange(wall_, fresh->wall);
    const auto viewer = view_.viewer;
    view_ = viewOf(command_, windowOf(wall_->display()));
    if (tracked_) view_.viewer = viewer;
    pointers_ = PointerMap(*wall_, wall_->desktop());
    if (stereo_ && wall_->desktop() != old->desktop()) stereo_.emplace(hidden_, wall_->desktop());
    setTables(*wall_, screens_, options_.inHardware, keeper_);
    printFits(command_, *wall_, model_);
    fmt::print("a new calibration is shown\n");
    std::fflush(stdout);
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

  void openProjector(const ProjectorScreen& screen) {
    const auto index = screen.projector;
    auto window = std::make_unique<devices::Window>(loop_,
                                                    devices::WindowRequest{.title = "PixelFlex " + model_.name(index),
                                                                           .size = model_.resolution(index),
                                                                           .at = screen.at,
                                                                           .borderless = true},
                                                    &hidden_);
    add({std::move(window),
         [this, index](devices::Window& to) { to.present(model_.texture(index), model_.resolution(index)); },
         [this, index](const devices::Window&, glm::dvec2 p) -> std::optional<glm::dvec2> {
           const auto there = pointers_.fromProjector(index, p);
           return there ? std::optional(glm::dvec2(*there)) : std::nullopt;
         }});
  }

  void openPreview() {
    const auto [width, height] = wall_->desktop();
    constexpr int kWidth = 1200;
    const int rows = std::clamp(static_cast<int>(std::int64_t{kWidth} * height / width), 100, 1000);
    auto window = std::make_unique<devices::Window>(
        loop_, devices::WindowRequest{.title = "PixelFlex: the model", .size = {kWidth, rows}}, &hidden_);
    if (command_.stereo != StereoKind::kOff) stereo_.emplace(hidden_, wall_->desktop());
    add({std::move(window), [this](devices::Window& to) { to.present(desktopTexture(), wall_->desktop()); },
         [this](const devices::Window& from, glm::dvec2 p) -> std::optional<glm::dvec2> {
           const glm::dvec2 size(from.size().width, from.size().height);
           return p / glm::max(size, 1.0) * glm::dvec2(wall_->desktop().width, wall_->desktop().height);
         }});
  }

  [[nodiscard]] devices::GlName desktopTexture() {
    if (!stereo_) return model_.desktopTexture(model_.desktopCount() - 1);
    return stereo_->texture();
  }

  void openRoom() {
    const auto shining = roomOf(command_, *wall_);
    if (shining.empty()) return;
    room_.emplace(hidden_, *wall_, command_.wall, shining);
    constexpr int kWidth = 1400;
    auto window = std::make_unique<devices::Window>(
        loop_, devices::WindowRequest{.title = "PixelFlex: the room", .size = room_->sizeFor(kWidth)}, &hidden_);
    add({std::move(window), [this](devices::Window& to) { presentRoom(to); },
         [this](const devices::Window&, glm::dvec2 p) -> std::optional<glm::dvec2> {
           if (room_->framing().picture.area() == 0) return std::nullopt;
           return glm::dvec2(pointers_.fromWall(room_->framing().wallFromPicture(p)));
         }});
  }

  void presentRoom(devices::Window& window) {
    room_->draw(model_, window.size());
    if (window.size().area() == 0) return;  // minimised
    window.present(room_->texture(), window.size());
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
  std::shared_ptr<const WallPlan> wall_;
  devices::GammaKeeper* keeper_;
  devices::EventLoop loop_;
  devices::Window hidden_;
  std::vector<ProjectorScreen> screens_;
  ModelWallOptions options_;
  ModelWall model_;
  ModelView view_;
  ModelNavigation navigation_;
  PointerMap pointers_;
  ModelTracker tracker_{STDIN_FILENO};
  std::optional<StereoPicture> stereo_;
  std::optional<ModelRoom> room_;
  std::vector<Shown> windows_;
  bool moved_ = false;
  bool tracked_ = false;
  bool quit_ = false;
  WallReloader reloader_;  // last: its thread ends first
};

}  // namespace

int runModelWindows(const ModelCommand& command, std::shared_ptr<const WallPlan> wall, Scene scene) {
  auto keeper = keeperFor(command, *wall);
  // The signal's thread must exist before any other, but what it wakes comes later.
  std::atomic<bool> open = false;
  const QuitSignal signal([&open] {
    if (open) devices::EventLoop::wake();
  });
  ModelWindows windows(command, std::move(wall), std::move(scene), keeper ? &*keeper : nullptr);
  open = true;
  const int status = windows.run(signal);
  open = false;
  return status;
}

}  // namespace pixelflex::viewer
