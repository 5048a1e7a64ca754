#include "viewer/programs/model_outputs.h"

#include <algorithm>

#include "devices/display/monitors.h"
#include "viewer/plan/one_pass_fit.h"
#include "viewer/plan/output_ramp.h"

namespace pixelflex::viewer {
namespace {

bool isWindow(calib::OutputKind kind) {
  return kind == calib::OutputKind::kMonitor || kind == calib::OutputKind::kDisplay;
}

}  // namespace

const calib::Output& outputOf(const WallPlan& wall, const std::string& projector) {
  const auto& all = wall.wall().projectors;
  const auto found = std::ranges::find(all, projector, &calib::ProjectorConfig::name);
  if (found == all.end()) throw PlanError("wall.yaml has no projector " + projector + " any more: calibrate again");
  return found->output;
}

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

std::vector<std::size_t> roomOf(const ModelCommand& command, const WallPlan& wall) {
  std::vector<std::size_t> shining;
  for (std::size_t i = 0; i < wall.projectors().size(); ++i) {
    const bool simulated = outputOf(wall, wall.projectors()[i]->name).kind == calib::OutputKind::kSim;
    if (command.room || simulated) shining.push_back(i);
  }
  return shining;
}

std::vector<ProjectorScreen> screensOf(const WallPlan& wall, const devices::EventLoop& loop) {
  std::vector<ProjectorScreen> screens;
  for (std::size_t i = 0; i < wall.projectors().size(); ++i) {
    const auto& output = outputOf(wall, wall.projectors()[i]->name);
    if (!isWindow(output.kind)) continue;
    const bool monitor = output.kind == calib::OutputKind::kMonitor;
    screens.push_back({i, monitor ? devices::findMonitor(loop, output.monitor).position : output.at});
  }
  return screens;
}

std::optional<devices::GammaKeeper> keeperFor(const ModelCommand& command, const WallPlan& wall) {
  const bool windows = std::ranges::any_of(
      wall.projectors(), [&](const auto* projector) { return isWindow(outputOf(wall, projector->name).kind); });
  if (!windows || command.draw.passes != 1 || command.lookUp == LookUp::kPass) return std::nullopt;
  return std::optional<devices::GammaKeeper>(std::in_place, displayOf(wall));
}

std::vector<std::string> lookedUpInHardware(const ModelCommand& command, const WallPlan& wall,
                                            const std::vector<ProjectorScreen>& screens, devices::GammaKeeper* keeper) {
  std::vector<std::string> names;
  if (keeper == nullptr) return names;
  for (const auto& screen : screens) {
    const auto& projector = *wall.projectors()[screen.projector];
    if (lightPlanOf(wall, screen.projector).inverseResponse[0].empty()) continue;
    if (keeper->entriesAt(screen.at, projector.resolution) > 0) {
      names.push_back(projector.name);
    } else if (command.lookUp == LookUp::kRamp) {
      throw PlanError("projector " + projector.name +
                      ": no output shows just its window and has a gamma ramp; leave --lut ramp away");
    }
  }
  return names;
}

void setTables(const WallPlan& wall, const std::vector<ProjectorScreen>& screens, const std::vector<std::string>& names,
               devices::GammaKeeper* keeper) {
  for (const auto& screen : screens) {
    const auto& projector = *wall.projectors()[screen.projector];
    if (std::ranges::find(names, projector.name) == names.end()) continue;
    const auto response = lightPlanOf(wall, screen.projector).inverseResponse;
    const auto entries = keeper->entriesAt(screen.at, projector.resolution);
    if (entries == 0) continue;  // switched off meanwhile
    keeper->set(screen.at, projector.resolution, rampOf(response, entries));
  }
}

}  // namespace pixelflex::viewer
