#include "viewer/programs/projector_windows.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace pixelflex::viewer {
namespace {

/// Where the output is now: its monitor by name, or any that shows a part of its place. Null: nowhere.
const devices::Monitor* monitorOf(const calib::Output& output, devices::Size size,
                                  std::span<const devices::Monitor> monitors) {
  const auto lights = [&](const devices::Monitor& monitor) {
    if (output.kind == calib::OutputKind::kMonitor) return monitor.name == output.monitor;
    const glm::ivec2 from = output.at - monitor.position;
    return from.x < monitor.size.width && from.y < monitor.size.height && from.x + size.width > 0 &&
           from.y + size.height > 0;
  };
  const auto found = std::ranges::find_if(monitors, lights);
  return found != monitors.end() ? &*found : nullptr;
}

std::string nameOf(const calib::Output& output) {
  if (output.kind == calib::OutputKind::kMonitor) return "monitor " + output.monitor;
  return fmt::format("the monitor at {}, {}", output.at.x, output.at.y);
}

void warnOfSize(const devices::Monitor& monitor, devices::Size resolution, const std::string& projector) {
  fmt::print(stderr, "pixelflex-view: warning: monitor {} is set to {}x{}, projector {} to {}x{}\n", monitor.name,
             monitor.size.width, monitor.size.height, projector, resolution.width, resolution.height);
}

}  // namespace

const calib::ProjectorConfig& configOf(const WallPlan& wall, const std::string& projector) {
  const auto& all = wall.wall().projectors;
  const auto found = std::ranges::find(all, projector, &calib::ProjectorConfig::name);
  if (found == all.end()) throw ViewError("wall.yaml has no projector " + projector + " any more: calibrate again");
  return *found;
}

ProjectorWindows::ProjectorWindows(devices::EventLoop& loop, const devices::Window& share, WallView& view, Input& input,
                                   int depth)
    : loop_(loop), view_(view) {
  for (std::size_t i = 0; i < view.wall().projectors().size(); ++i) open(i, share, input, depth);
  follow(devices::listMonitors(loop_));
}

void ProjectorWindows::open(std::size_t index, const devices::Window& share, Input& input, int depth) {
  const auto& projector = *view_.wall().projectors()[index];
  const auto& output = configOf(view_.wall(), projector.name).output;
  if (output.kind != calib::OutputKind::kMonitor && output.kind != calib::OutputKind::kDisplay) return;
  auto window = std::make_unique<devices::Window>(loop_,
                                                  devices::WindowRequest{.title = "PixelFlex " + projector.name,
                                                                         .size = projector.resolution,
                                                                         .borderless = true,
                                                                         .visible = false,
                                                                         .showPointer = false,
                                                                         .bitsPerColour = depth},
                                                  &share);
  const std::size_t number = windows_.size();
  input.take(
      *window,
      [this, index](glm::dvec2 p) {
        return view_.pointerMap() != nullptr ? view_.pointerMap()->fromProjector(index, p) : std::nullopt;
      },
      [this, number] { present(windows_[number]); }, true);
  windows_.push_back({index, projector.name, output, projector.flatAt, projector.resolution, std::move(window)});
}

void ProjectorWindows::follow(std::span<const devices::Monitor> monitors) {
  for (auto& projector : windows_) place(projector, monitorOf(projector.at, projector.resolution, monitors));
  pace();
}

void ProjectorWindows::place(Projector& projector, const devices::Monitor* monitor) {
  const std::string& name = projector.name;
  if (monitor == nullptr) {
    if (projector.shown) projector.window->show(false);
    projector.shown = false;
    if (std::exchange(projector.missed, true)) return;
    return fmt::print(stderr, "pixelflex-view: {} is not there: projector {} is dark until it returns\n",
                      nameOf(projector.at), name);
  }
  const bool byName = projector.at.kind == calib::OutputKind::kMonitor;
  projector.window->moveTo(byName ? monitor->position : projector.at.at);
  if (projector.shown) return;
  if (byName && monitor->size != projector.resolution) warnOfSize(*monitor, projector.resolution, name);
  projector.window->show(true);
  // A window manager may have moved it while it appeared.
  projector.window->moveTo(byName ? monitor->position : projector.at.at);
  projector.shown = true;
  present(projector);
  if (!std::exchange(projector.missed, false)) return;
  fmt::print(stderr, "pixelflex-view: {} is there: projector {} is shown\n", nameOf(projector.at), name);
}

/// The first that is shown.
void ProjectorWindows::pace() {
  bool paced = false;
  for (const auto& projector : windows_) {
    const bool paces = projector.shown && !paced;
    projector.window->pace(paces);
    paced = paced || paces;
  }
}

void ProjectorWindows::present(std::span<const std::size_t> outputs) {
  for (auto projector = windows_.rbegin(); projector != windows_.rend(); ++projector) {
    if (std::ranges::find(outputs, projector->output) != outputs.end()) presentDrawn(*projector);
  }
}

void ProjectorWindows::present(const Projector& projector) {
  auto& renderer = view_.renderer();
  if (!projector.shown || projector.output >= renderer.outputCount()) return;
  projector.window->present(renderer.outputTexture(projector.output), renderer.outputResolution(projector.output));
}

void ProjectorWindows::presentDrawn(const Projector& projector) {
  auto& renderer = view_.renderer();
  if (!projector.shown || projector.output >= renderer.outputCount()) return;
  std::vector<devices::Part> parts;
  for (const auto& box : renderer.outputDrawn(projector.output).boxes()) {
    parts.push_back({{box.left, box.top}, {box.width(), box.height()}});
  }
  projector.window->present(renderer.outputTexture(projector.output), renderer.outputResolution(projector.output),
                            parts);
}

bool ProjectorWindows::anyShown() const {
  return std::ranges::any_of(windows_, &Projector::shown);
}

bool ProjectorWindows::lieAsOnTheWall() const {
  std::optional<glm::ivec2> origin;  // of the desktop, on the display
  for (const auto& projector : windows_) {
    if (!projector.shown) continue;
    const auto& flatAt = projector.flatAt;
    const bool first = !origin;
    if (first) origin = projector.window->position() - flatAt.value_or(glm::ivec2(0, 0));
    if (!first && (!flatAt || projector.window->position() - *flatAt != *origin)) return false;
  }
  return true;
}

}  // namespace pixelflex::viewer
