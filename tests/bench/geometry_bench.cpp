#include <benchmark/benchmark.h>

#include <algorithm>

#include "calib/geometry/display_area.h"
#include "calib/geometry/patch_mesh.h"
#include "calib/photometric/mask.h"

namespace pixelflex::calib {
namespace {

constexpr devices::Size kResolution{1024, 768};

/// Keystoned and lens-distorted, its middle at a place of the wall, about a pixel a unit.
ProjectorMapping projectorAt(glm::dvec2 middle, double keystone) {
  constexpr double kScale = 1024;
  const ProjectorModel model{.projectorFromWall = {1 / kScale, 0, -middle.x / kScale, 0, 1 / kScale, -middle.y / kScale,
                                                   keystone, 0, 1 - keystone * middle.x},
                             .centre = {kResolution.width / 2.0, kResolution.height / 2.0},
                             .scale = kScale,
                             .radial = {-0.03, 0.01, 0}};
  return {model, kResolution};
}

/// Four columns and as many rows as that takes, overlapping by a fifth sideways and a tenth up and down.
std::vector<ProjectorMapping> wallOf(int projectors) {
  std::vector<ProjectorMapping> mappings;
  for (int i = 0; i < projectors; ++i) {
    const int column = i % 4;
    const int row = i / 4;
    mappings.push_back(projectorAt({820.0 * column, 700.0 * row}, (i % 3 - 1) * 5e-5));
  }
  return mappings;
}

std::vector<Outline> footprintsOf(const std::vector<ProjectorMapping>& mappings) {
  std::vector<Outline> outlines;
  for (const auto& mapping : mappings) outlines.push_back(footprint(mapping));
  return outlines;
}

double widthOf(const std::vector<Outline>& outlines) {
  double low = 1e9;
  double high = -1e9;
  for (const auto& outline : outlines) {
    for (const glm::dvec2 point : outline) {
      low = std::min(low, point.x);
      high = std::max(high, point.x);
    }
  }
  return high - low;
}

/// findDisplay() of eight footprints on a lattice as many cells wide as the argument says.
void displayArea(benchmark::State& state, std::optional<AspectRatio> aspect) {
  const auto outlines = footprintsOf(wallOf(8));
  const std::vector<double> densities(outlines.size(), 1.0);
  const double density = static_cast<double>(state.range(0)) / widthOf(outlines);
  const DisplayRequest request{.aspect = aspect, .margin = 24};
  const DesktopRequest desktop{.density = DensityRule::kFixed, .pixelsPerUnit = density};
  Display display;
  for (auto _ : state) {
    display = findDisplay(outlines, densities, request, desktop);
    benchmark::DoNotOptimize(display);
  }
  const Coverage coverage(outlines, density);
  state.counters["lattice_width"] = coverage.width();
  state.counters["lattice_height"] = coverage.height();
}

void displayAreaAny(benchmark::State& state) {
  displayArea(state, std::nullopt);
}

void displayArea16To9(benchmark::State& state) {
  displayArea(state, AspectRatio{16, 9});
}

/// All masks of a wall of as many projectors as the argument says.
void masks(benchmark::State& state) {
  const auto mappings = wallOf(static_cast<int>(state.range(0)));
  const std::vector<double> densities(mappings.size(), 1.0);
  for (auto _ : state) {
    for (std::size_t i = 0; i < mappings.size(); ++i) {
      benchmark::DoNotOptimize(alphaMask(i, mappings, densities, {}));
    }
  }
}

/// All meshes of a wall of as many projectors as the argument says, over patches of 1024x1024.
void patchMeshes(benchmark::State& state) {
  const auto mappings = wallOf(static_cast<int>(state.range(0)));
  const auto outlines = footprintsOf(mappings);
  const std::vector<double> densities(mappings.size(), 1.0);
  const Display display = findDisplay(outlines, densities, {}, {});
  std::vector<DesktopPatch> patches;
  const devices::Size size = display.resolution;
  for (int y = 0; y < size.height; y += 1024) {
    for (int x = 0; x < size.width; x += 1024) {
      patches.push_back({x, y, std::min(x + 1024, size.width), std::min(y + 1024, size.height)});
    }
  }
  for (auto _ : state) {
    for (const auto& mapping : mappings) benchmark::DoNotOptimize(buildPatchMesh(mapping, display, patches));
  }
}

BENCHMARK(displayAreaAny)->Arg(768)->Arg(7680)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(displayArea16To9)->Arg(768)->Arg(7680)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(masks)->Arg(2)->Arg(8)->Arg(32)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(patchMeshes)->Arg(2)->Arg(8)->Arg(32)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace pixelflex::calib

BENCHMARK_MAIN();
