#include "viewer/plan/wall_plan.h"

#include <algorithm>
#include <cstddef>
#include <future>
#include <utility>

#include "calib/geometry/footprint.h"
#include "calib/geometry/patch_mesh.h"
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

std::vector<calib::DesktopPatch> patchesOf(const TileLayout& layout) {
  std::vector<calib::DesktopPatch> patches;
  for (int layer = 0; layer < layout.count(); ++layer) {
    const Box patch = layout.patch(layer);
    patches.push_back({patch.left, patch.top, patch.right, patch.bottom});
  }
  return patches;
}

WarpMesh toWarpMesh(const calib::PatchMesh& mesh) {
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
    warp.patches.push_back({static_cast<int>(patch.patch), first, count});
  }
  return warp;
}

}  // namespace

WallPlan::WallPlan(const std::filesystem::path& folder, calib::Wall wall, calib::Calibration calibration,
                   const std::vector<std::string>& only)
    : wall_(std::move(wall)), calibration_(std::move(calibration)) {
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
    light_.push_back(readLight(folder, projector));
  }
}

std::vector<OutputPlan> WallPlan::outputsFor(devices::Size desktop) const {
  const auto every = [&](std::size_t first, std::size_t step) {
    std::vector<OutputPlan> plans;
    for (std::size_t i = first; i < projectors_.size(); i += step) plans.push_back(outputFor(i, desktop));
    return plans;
  };
  auto odd = std::async(std::launch::async, every, 1, 2);
  auto even = every(0, 2);
  auto odds = odd.get();
  std::vector<OutputPlan> plans;
  for (std::size_t i = 0; i < projectors_.size(); ++i) plans.push_back(std::move((i % 2 == 0 ? even : odds)[i / 2]));
  return plans;
}

OutputPlan WallPlan::outputFor(std::size_t index, devices::Size desktop) const {
  const auto& projector = *projectors_[index];
  const auto& light = light_[index];
  OutputPlan plan{
      .name = projector.name,
      .resolution = projector.resolution,
      .desktop = desktop,
      .colour = light.colour,
      .alpha = light.alpha,
      .gain = light.gain,
      .black = light.black,
      .largestBlack = static_cast<float>(calib::kLargestBlackLift),
      .inverseResponse = light.inverseResponse,
      .transfer = wall_.transfer == calib::Transfer::kSrgb ? DesktopTransfer::kSrgb : DesktopTransfer::kLinear,
      .filter = filterOf(wall_.desktop.filter),
      .filterDomain =
          wall_.desktop.filterDomain == calib::FilterDomain::kLinear ? FilterDomain::kLinear : FilterDomain::kSrgb,
      .exactAt = projector.flatAt};
  if (projector.flatAt) return plan;
  calib::Display display = display_;
  display.resolution = desktop;
  const calib::ProjectorMapping mapping(projector);
  const TileLayout layout(desktop);
  try {
    plan.mesh = toWarpMesh(calib::buildPatchMesh(mapping, display, patchesOf(layout)));
  } catch (const calib::GeometryError& error) {
    throw PlanError("projector " + projector.name + ": " + error.what() + "; calibrate it again");
  }
  return plan;
}

}  // namespace pixelflex::viewer
