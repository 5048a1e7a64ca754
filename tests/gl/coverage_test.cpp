// Meshes of calibrated projectors: patches cover each projector's part of the display exactly once, with no cracks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "calib/geometry/patch_mesh.h"
#include "devices/display/gl_context.h"
#include "tests/gl/mesh_count.h"
#include "tests/gl/plans.h"
#include "viewer/plan/wall_plan.h"
#include "viewer/renderer/wall_renderer.h"
#include "viewer/tiles/tile_layout.h"

namespace pixelflex::viewer {
namespace {

using devices::Size;

constexpr Size kFrame{1024, 768};

enum class Model { kKeystone, kShortThrow, kBent, kResidual, kNudged, kAll };

calib::ProjectorCalibration projectorOf(Model kind) {
  calib::ProjectorCalibration projector{.name = "p1", .resolution = kFrame};
  auto& model = projector.model;
  model = {.projectorFromWall = {1.0e-3, 6e-5, -0.55, -4e-5, 0.98e-3, -0.38, 5e-5, 3e-5, 1},
           .centre = {530, 350},
           .scale = 1024};
  const bool all = kind == Model::kAll;
  if (kind == Model::kShortThrow || all) {
    model.radial = {-0.15, 0.03, 0};
    model.tangential = {5e-4, -3e-4};
  }
  if (kind == Model::kBent || all) model.bend = calib::Bend{.radius = 3000, .apex = 500, .depth = {2e-5, 5e-5, 3e-4}};
  if (kind == Model::kResidual || all) {
    calib::ResidualSpline spline{.columns = 4, .rows = 3, .control = {}};
    for (int i = 0; i < 42; ++i) spline.control.emplace_back(0.8 * std::sin(1.7 * i), 0.6 * std::cos(2.3 * i));
    model.residual = spline;
  }
  if (kind == Model::kNudged || all) {
    projector.nudge = calib::Nudge{
        .shift = {1.37, -2.71}, .roll = 0.3, .corners = {{{3.1, 0.4}, {-1.2, 0.9}, {0.3, -2.2}, {1.9, 1.1}}}};
  }
  return projector;
}

enum class Place { kFrameInsideDisplay, kDisplayCutsFrame };

calib::Display displayOf(Place place) {
  if (place == Place::kFrameInsideDisplay) return {-500, -400, 1900, 1400, {2400, 1800}};
  return {103, 81.5, 897, 702, {1600, 1251}};
}

std::vector<calib::DesktopPatch> patchesOf(Size desktop, int stride) {
  std::vector<calib::DesktopPatch> patches;
  for (int y = 0; y < desktop.height; y += stride) {
    for (int x = 0; x < desktop.width; x += stride) {
      patches.push_back({x, y, std::min(x + stride, desktop.width), std::min(y + stride, desktop.height)});
    }
  }
  return patches;
}

/// As the plan gives it to the renderer, for patches of any size.
WarpMesh meshOf(const calib::PatchMesh& mesh) {
  WarpMesh warp;
  for (const auto& v : mesh.vertices) {
    warp.vertices.push_back({static_cast<float>(v.pointInProjector.x), static_cast<float>(v.pointInProjector.y),
                             static_cast<float>(v.pointInDesktop.x * v.weight),
                             static_cast<float>(v.pointInDesktop.y * v.weight), static_cast<float>(v.weight)});
  }
  for (const auto& patch : mesh.patches) {
    const auto first = static_cast<std::uint32_t>(warp.indices.size());
    for (const auto& triangle : patch.triangles) {
      warp.indices.insert(warp.indices.end(), triangle.begin(), triangle.end());
    }
    warp.patches.push_back(
        {static_cast<int>(patch.patch), first, static_cast<std::uint32_t>(warp.indices.size()) - first});
  }
  return warp;
}

/// How far inside the display's border a pixel's centre is, desktop pixels; negative outside.
double depthInDisplay(const calib::ProjectorMapping& mapping, const calib::Display& display, int x, int y) {
  const auto inWall = mapping.wallFromProjector({x + 0.5, y + 0.5});
  if (!inWall) return -1e9;
  const glm::dvec2 p = calib::desktopFromWall(display).map(*inWall);
  return std::min({p.x, p.y, display.resolution.width - p.x, display.resolution.height - p.y});
}

using Parameter = std::tuple<Model, Place, int>;

class CoverageTest : public ::testing::TestWithParam<Parameter> {
 protected:
  const calib::ProjectorCalibration projector_ = projectorOf(std::get<0>(GetParam()));
  const calib::Display display_ = displayOf(std::get<1>(GetParam()));
  const calib::ProjectorMapping mapping_{projector_};
  const WarpMesh mesh_ =
      meshOf(calib::buildPatchMesh(mapping_, display_, patchesOf(display_.resolution, std::get<2>(GetParam()))));
};

TEST_P(CoverageTest, CoversEveryPixelExactlyOnce) {
  const devices::HeadlessContext context;
  const auto count = testing::countTriangles(mesh_, kFrame);
  std::int64_t inside = 0;
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      ASSERT_LE(count.at(x, y), 1) << x << ", " << y;
      const double depth = depthInDisplay(mapping_, display_, x, y);
      constexpr double kMeshError = 0.02;  // desktop pixels, on the display's border alone
      if (std::abs(depth) < kMeshError) continue;
      ASSERT_EQ(count.at(x, y), depth > 0 ? 1 : 0) << x << ", " << y << ", depth " << depth;
      inside += count.at(x, y);
    }
  }
  EXPECT_GT(inside, kFrame.area() / 2);
}

using Corner = std::array<float, 5>;

Corner bitsOf(const WarpVertex& v) {
  return {v.x, v.y, v.uw, v.vw, v.w};
}

/// The edges of all triangles as their corners' numbers in the order of the mesh, with how often each is walked that
/// way.
std::map<std::pair<Corner, Corner>, int> edgesOf(const WarpMesh& mesh) {
  std::map<std::pair<Corner, Corner>, int> edges;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto from = bitsOf(mesh.vertices[mesh.indices[i + k]]);
      const auto to = bitsOf(mesh.vertices[mesh.indices[i + (k + 1) % 3]]);
      ++edges[{from, to}];
    }
  }
  return edges;
}

/// A triangle whose neighbour has not the same two corners to the last bit, or has a corner within the edge (a
/// T-junction), leaves an edge without its counterpart.
TEST_P(CoverageTest, NeighboursShareTheirCornersToTheLastBit) {
  const auto edges = edgesOf(mesh_);
  const auto onBorder = [&](const Corner& c) {
    constexpr double kRounding = 1e-3;
    const double u = c[2] / c[4];
    const double v = c[3] / c[4];
    return std::array<bool, 8>{c[0] == 0,
                               c[1] == 0,
                               c[0] == kFrame.width,
                               c[1] == kFrame.height,
                               std::abs(u) < kRounding,
                               std::abs(v) < kRounding,
                               std::abs(u - display_.resolution.width) < kRounding,
                               std::abs(v - display_.resolution.height) < kRounding};
  };
  for (const auto& [edge, times] : edges) {
    ASSERT_EQ(times, 1);
    if (edges.contains({edge.second, edge.first})) continue;
    const auto from = onBorder(edge.first);
    const auto to = onBorder(edge.second);
    bool outer = false;
    for (std::size_t side = 0; side < from.size(); ++side) outer = outer || (from[side] && to[side]);
    ASSERT_TRUE(outer) << "(" << edge.first[0] << ", " << edge.first[1] << ") to (" << edge.second[0] << ", "
                       << edge.second[1] << ")";
  }
}

INSTANTIATE_TEST_SUITE_P(All, CoverageTest,
                         ::testing::Combine(::testing::Values(Model::kKeystone, Model::kShortThrow, Model::kBent,
                                                              Model::kResidual, Model::kNudged, Model::kAll),
                                            ::testing::Values(Place::kFrameInsideDisplay, Place::kDisplayCutsFrame),
                                            ::testing::Values(kTileStride, 61)));

TEST(MeshCount, SeesOverlapsAndGaps) {
  const devices::HeadlessContext context;
  WarpMesh mesh;
  mesh.vertices = {{0, 0}, {8, 0}, {8, 8}, {0, 8}, {7, 0}, {7, 8}, {2, 0}, {2, 8}};
  mesh.indices = {0, 4, 5, 0, 5, 3, 6, 1, 2, 6, 2, 7};  // columns 0 to 7 and 2 to 8, row 8 of ten empty
  mesh.patches = {{0, 0, 6}, {1, 6, 6}};
  const auto count = testing::countTriangles(mesh, {8, 10});
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 8; ++x) EXPECT_EQ(count.at(x, y), y >= 8 ? 0 : x >= 2 && x < 7 ? 2 : 1) << x << ", " << y;
  }
}

class PlanTest : public ::testing::Test {
 protected:
  static std::vector<OutputPlan> plansOf(Model model, const calib::Display& display) {
    calib::Calibration calibration;
    calibration.projectors = {projectorOf(model)};
    calibration.display = display;
    auto plans = WallPlan({}, {}, calibration, {}).outputsFor(display.resolution);
    plans[0].dither = false;
    return plans;
  }
  devices::Image8 draw(const std::vector<OutputPlan>& plans, const devices::Image8& desktop) {
    WallRenderer renderer(context_);
    renderer.setPlans(plans);
    renderer.upload(testing::wholeBatch(desktop));
    renderer.draw();
    return renderer.readOutput(0);
  }
  devices::HeadlessContext context_;
};

/// The renderer's own drawing reaches exactly the pixels that are counted once.
TEST_F(PlanTest, TheRendererDrawsWhatIsCovered) {
  auto display = displayOf(Place::kDisplayCutsFrame);
  display.resolution = {3100, 2400};  // four tiles by three
  const auto plans = plansOf(Model::kAll, display);
  const auto count = testing::countTriangles(plans[0].mesh, kFrame);
  EXPECT_GT(plans[0].mesh.patches.size(), 8U);
  WallRenderer renderer(context_, {.measure = true});
  renderer.setPlans(plans);
  renderer.uploadDesktop(devices::ImageF(display.resolution, 4));
  renderer.draw();
  const auto frame = renderer.readOutputFloat(0);
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      ASSERT_EQ(frame.at(x, y, 3), static_cast<float>(count.at(x, y))) << x << ", " << y;
    }
  }
}

int apart(const devices::Image8& a, const devices::Image8& b, int x, int y) {
  int most = 0;
  for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(a.at(x, y, c) - b.at(x, y, c)));
  return most;
}

/// The same picture in the same place of the wall, once as a desktop of a single tile, once as the corner of a larger
/// desktop where four tiles meet in its middle.
TEST_F(PlanTest, TiledDrawingIsUntiledDrawing) {
  const calib::Display small{103, 81.5, 897, 702, {1016, 794}};
  const auto picture = testing::testDesktop(small.resolution);
  const glm::ivec2 moved(kTileStride - 511, kTileStride - 402);
  calib::Display large = small;
  large.resolution = {small.resolution.width + moved.x, small.resolution.height + moved.y};
  large.left -= moved.x * (small.right - small.left) / small.resolution.width;
  large.top -= moved.y * (small.bottom - small.top) / small.resolution.height;
  devices::Image8 around(large.resolution, 3);
  for (int y = 0; y < picture.height(); ++y) {
    std::ranges::copy(picture.row(y), around.row(y + moved.y).begin() + 3 * std::ptrdiff_t{moved.x});
  }
  for (const Model model : {Model::kKeystone, Model::kShortThrow, Model::kBent, Model::kAll}) {
    const auto onePlan = plansOf(model, small);
    const auto fourPlans = plansOf(model, large);
    EXPECT_EQ(onePlan[0].mesh.patches.size(), 1U);
    EXPECT_EQ(fourPlans[0].mesh.patches.size(), 4U);
    const auto untiled = draw(onePlan, picture);
    const auto tiled = draw(fourPlans, around);
    const calib::ProjectorMapping mapping(projectorOf(model));
    std::int64_t compared = 0;
    std::int64_t beyondOne = 0;
    for (int y = 0; y < kFrame.height; ++y) {
      for (int x = 0; x < kFrame.width; ++x) {
        if (depthInDisplay(mapping, small, x, y) < 3) continue;  // there the filter reaches past the border
        ++compared;
        beyondOne += apart(tiled, untiled, x, y) > 1 ? 1 : 0;
      }
    }
    EXPECT_GT(compared, kFrame.area() / 2);
    // The picture has lines of one pixel at full contrast: where a lens bends the mesh, a triangle cut by a tile's
    // border may move them by as much as the mesh is off the model.
    EXPECT_LE(static_cast<double>(beyondOne), model == Model::kKeystone ? 0 : 2e-3 * static_cast<double>(compared));
  }
}

}  // namespace
}  // namespace pixelflex::viewer
