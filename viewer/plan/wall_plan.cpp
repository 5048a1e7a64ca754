#include "viewer/plan/wall_plan.h"

#include <algorithm>
#include <cstddef>
#include <future>
#include <utility>

#include "calib/geometry/footprint.h"
#include "calib/geometry/patch_mesh.h"
#include "viewer/plan/scaled_screen.h"
#include "viewer/tiles/tile_layout.h"

namespace pixelflex::viewer {
namespace {

Filter filterOf(calib::DesktopFilter filter) {
  switch (filter) {
    case calib::DesktopFilter::kBilinear:
      return Filter::kBilinear;
    case calib::DesktopFilter::kNearest:
      return Filter::kNearest;
    case calib::DesktopFilter::kCatmullRom:
      break;
  }
  return Filter::kCatmullRom;
}

/// The shown part of the desktop, cut into tiles.
struct ShownPatches {
  std::vector<calib::DesktopPatch> patches;
  std::vector<int> layers;  // of each
};

ShownPatches patchesOf(const TileLayout& layout, const Box& shown) {
  ShownPatches result;
  for (int layer = 0; layer < layout.count(); ++layer) {
    const Box patch = intersect(layout.patch(layer), shown);
    if (patch.empty()) continue;
    result.patches.push_back({patch.left, patch.top, patch.right, patch.bottom});
    result.layers.push_back(layer);
  }
  return result;
}

WarpMesh toWarpMesh(const calib::PatchMesh& mesh, const std::vector<int>& layers) {
  WarpMesh warp;
  for (const auto& vertex : mesh.vertices) {
    const double w = vertex.weight;
    warp.vertices.push_back({static_cast<float>(vertex.pointInProjector.x),
                             static_cast<float>(vertex.pointInProjector.y),
                             static_cast<float>(vertex.pointInDesktop.x * w),
                             static_cast<float>(vertex.pointInDesktop.y * w), static_cast<float>(w)});
  }
  for (const auto& patch : mesh.patches) {
    const auto first = static_cast<std::uint32_t>(warp.indices.size());
    for (const auto& triangle : patch.triangles) {
      warp.indices.insert(warp.indices.end(), triangle.begin(), triangle.end());
    }
    const auto count = static_cast<std::uint32_t>(warp.indices.size()) - first;
    warp.patches.push_back({layers[patch.patch], first, count});
  }
  return warp;
}

/// Of a screen that is not flat.
void addMesh(OutputPlan& plan, const calib::ProjectorCalibration& projector, const calib::Display& display,
             const Box& shown) {
  try {
    const ShownPatches cut = patchesOf(TileLayout(plan.desktop), shown);
    plan.mesh = toWarpMesh(calib::buildPatchMesh(calib::ProjectorMapping(projector), display, cut.patches), cut.layers);
  } catch (const calib::GeometryError& error) {
    throw PlanError("projector " + projector.name + ": " + error.what() + "; calibrate it again");
  }
}

/// The codes of a desktop that is scaled reach a flat screen as those of one that is not: without its response.
void showFlat(OutputPlan& plan, const TileLayout& layout, const Placement& placement, glm::ivec2 screenAt) {
  plan.exactShown = placement.shown;
  if (const auto desktopAt = placement.oneToOneAt()) {
    plan.exactAt = screenAt - *desktopAt;
    return;
  }
  plan.inverseResponse = {};
  plan.mesh = scaledScreen(layout, placement, screenAt, plan.resolution);
}

/// make(0) … make(count - 1), by two threads.
template <class Make>
auto inTwoThreads(std::size_t count, const Make& make) {
  const auto every = [&](std::size_t first, std::size_t step) {
    std::vector<decltype(make(first))> some;
    for (std::size_t i = first; i < count; i += step) some.push_back(make(i));
    return some;
  };
  auto odd = std::async(std::launch::async, every, 1, 2);
  auto even = every(0, 2);
  auto odds = odd.get();
  decltype(even) all;
  for (std::size_t i = 0; i < count; ++i) all.push_back(std::move((i % 2 == 0 ? even : odds)[i / 2]));
  return all;
}

}  // namespace

WallPlan::WallPlan(const std::filesystem::path& folder, calib::Wall wall, calib::Calibration calibration,
                   const std::vector<std::string>& only, const FitOptions& fit)
    : wall_(std::move(wall)), calibration_(std::move(calibration)), fit_(fit) {
  if (!calibration_.display || calibration_.projectors.empty()) {
    throw PlanError(folder.string() + ": the wall is not fully calibrated: run pixelflex calibrate " + folder.string());
  }
  display_ = *calibration_.display;
  for (const auto& name : only) {
    if (calibration_.find(name) == nullptr) {
      throw PlanError(folder.string() + ": no calibrated projector is called " + name);
    }
  }
  for (const auto& projector : calibration_.projectors) {
    if (!only.empty() && std::ranges::find(only, projector.name) == only.end()) continue;
    projectors_.push_back(&projector);
  }
  light_ = inTwoThreads(projectors_.size(), [&](std::size_t i) { return readLight(folder, *projectors_[i]); });
}

Placement WallPlan::placementOf(devices::Size desktop) const {
  return placeDesktop(display_.resolution, desktop, fit_);
}

calib::Display WallPlan::displayOf(devices::Size desktop) const {
  const Placement placement = placementOf(desktop);
  if (placement == Placement{boxOf(display_.resolution)}) return display_;
  const glm::dvec2 corner(display_.left, display_.top);
  const glm::dvec2 unit{(display_.right - display_.left) / display_.resolution.width,
                        (display_.bottom - display_.top) / display_.resolution.height};
  const glm::dvec2 low = corner + unit * placement.wallFromDesktop({0, 0});
  const glm::dvec2 high = corner + unit * placement.wallFromDesktop({desktop.width, desktop.height});
  return {low.x, low.y, high.x, high.y, desktop};
}

std::vector<OutputPlan> WallPlan::outputsFor(devices::Size desktop) const {
  return inTwoThreads(projectors_.size(), [&](std::size_t i) { return outputFor(i, desktop); });
}

OutputPlan WallPlan::outputFor(std::size_t index, devices::Size desktop) const {
  const auto& projector = *projectors_[index];
  OutputPlan plan = lightFor(index, desktop);
  const Placement placement = placementOf(desktop);
  if (projector.flatAt) {
    showFlat(plan, TileLayout(desktop), placement, *projector.flatAt);
  } else {
    addMesh(plan, projector, displayOf(desktop), placement.shown);
  }
  return plan;
}

OutputPlan WallPlan::outputFor(std::size_t index, const calib::Display& part) const {
  OutputPlan plan = lightFor(index, part.resolution);
  addMesh(plan, *projectors_.at(index), part, boxOf(part.resolution));
  return plan;
}

OutputPlan WallPlan::lightFor(std::size_t index, devices::Size desktop) const {
  const auto& projector = *projectors_.at(index);
  const auto& light = light_[index];
  return {.name = projector.name,
          .resolution = projector.resolution,
          .desktop = desktop,
          .colour = light.colour,
          .alpha = light.alpha,
          .gain = light.gain,
          .black = light.black,
          .largestBlack = light.largestBlack,
          .inverseResponse = light.inverseResponse,
          .transfer = wall_.transfer == calib::Transfer::kSrgb ? DesktopTransfer::kSrgb : DesktopTransfer::kLinear,
          .filter = filterOf(wall_.desktop.filter),
          .filterDomain =
              wall_.desktop.filterDomain == calib::FilterDomain::kLinear ? FilterDomain::kLinear : FilterDomain::kSrgb};
}

}  // namespace pixelflex::viewer
