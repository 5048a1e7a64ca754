#include "calib/programs/live_wall.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "calib/simulate/room_folder.h"
#include "devices/display/event_loop.h"
#include "devices/display/monitors.h"
#include "devices/display/window_projector.h"

namespace pixelflex::calib {
namespace {

constexpr double kUsualLatency = 0.15;  // seconds from a window to the wall: some frames in the graphics and projector

class SimulatedLiveWall final : public LiveWall {
 public:
  SimulatedLiveWall(const std::filesystem::path& folder, const Wall& wall)
      : rig_(loadRig(folder / *wall.rig)), room_(folder / "room", rig_) {}
  [[nodiscard]] std::vector<devices::Projector*> projectors() override { return room_.projectors(); }
  [[nodiscard]] devices::Operator& person() override { return room_.person(); }
  [[nodiscard]] int placeCount() const override { return static_cast<int>(rig_.cameraPlaces.size()) + 1; }
  [[nodiscard]] int checkerboardCount() const override { return rig_.checkerboardPoses; }

 private:
  Rig rig_;
  PublishedRoom room_;
};

/// Whoever sits at the terminal. Where nobody does, the room counts as dark, and nothing else can be arranged.
class TerminalPerson final : public devices::Operator {
 public:
  [[nodiscard]] bool arrange(devices::Scene scene, int index) override {
    switch (scene) {
      case devices::Scene::kDark:
        if (::isatty(STDIN_FILENO) != 0) (void)ask("switch the lights out, then press Enter");
        return true;
      case devices::Scene::kRoomLight:
        return ask("switch the lights on, so that every marker is well lit, then press Enter");
      case devices::Scene::kCheckerboard:
        return ask(
            fmt::format("lights on; hold the checkerboard up, tilted another way than before (number {}), then "
                        "press Enter; q and Enter after the last",
                        index + 1));
    }
    return false;
  }

 private:
  /// Whether it was done.
  static bool ask(const std::string& what) {
    fmt::print("> {}: ", what);
    std::fflush(stdout);
    std::string line;
    return std::getline(std::cin, line) && !line.starts_with('q');
  }
};

/// A projector whose pictures take their time to the wall.
class LateProjector final : public devices::Projector {
 public:
  LateProjector(std::unique_ptr<devices::Projector> projector, double latency)
      : projector_(std::move(projector)), latency_(latency) {}
  [[nodiscard]] const std::string& name() const override { return projector_->name(); }
  [[nodiscard]] devices::Size resolution() const override { return projector_->resolution(); }
  void show(const devices::Image8& frame) override {
    projector_->show(frame);
    std::this_thread::sleep_for(latency_);
  }
  void blank() override {
    projector_->blank();
    std::this_thread::sleep_for(latency_);
  }

 private:
  std::unique_ptr<devices::Projector> projector_;
  std::chrono::duration<double> latency_;
};

/// The X display that all outputs are on; none: the environment's.
std::optional<std::string> displayOf(const Wall& wall) {
  std::vector<std::string> displays;
  for (const auto& projector : wall.projectors) {
    if (projector.output.kind == OutputKind::kNone || projector.output.kind == OutputKind::kSim) {
      throw std::runtime_error("projector " + projector.name +
                               " has no output to show patterns on: give it output: {monitor: NAME} in wall.yaml, or "
                               "photograph by hand (--patterns DIR, --photos DIR)");
    }
    displays.push_back(projector.output.kind == OutputKind::kDisplay ? projector.output.display : "");
  }
  const auto others = std::ranges::find_if(displays, [&](const auto& display) { return display != displays.front(); });
  if (others != displays.end()) {
    throw std::runtime_error(
        "the outputs are on several X displays, and patterns can be shown on one: use --skip or --only for the "
        "projectors of the others, or photograph by hand (--patterns DIR, --photos DIR)");
  }
  return displays.front().empty() ? std::nullopt : std::optional(displays.front());
}

class WindowWall final : public LiveWall {
 public:
  explicit WindowWall(const Wall& wall) : loop_(displayOf(wall)) {
    for (const auto& config : wall.projectors) {
      const Output& output = config.output;
      const glm::ivec2 at =
          output.kind == OutputKind::kMonitor ? devices::findMonitor(loop_, output.monitor).position : output.at;
      projectors_.push_back(std::make_unique<LateProjector>(
          std::make_unique<devices::WindowProjector>(config.name, loop_, config.resolution, at),
          wall.camera.latency.value_or(kUsualLatency)));
    }
  }
  [[nodiscard]] std::vector<devices::Projector*> projectors() override {
    std::vector<devices::Projector*> all;
    for (const auto& projector : projectors_) all.push_back(projector.get());
    return all;
  }
  [[nodiscard]] devices::Operator& person() override { return person_; }

 private:
  devices::EventLoop loop_;
  std::vector<std::unique_ptr<LateProjector>> projectors_;
  TerminalPerson person_;
};

}  // namespace

std::unique_ptr<LiveWall> openLiveWall(const std::filesystem::path& folder, const Wall& wall) {
  const bool simulated = std::ranges::all_of(
      wall.projectors, [](const auto& projector) { return projector.output.kind == OutputKind::kSim; });
  if (simulated) return std::make_unique<SimulatedLiveWall>(folder, wall);
  return std::make_unique<WindowWall>(wall);
}

}  // namespace pixelflex::calib
