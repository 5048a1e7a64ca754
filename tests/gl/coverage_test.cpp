// Meshes of calibrated projectors: patches cover each projector's part of the display exactly once, with no cracks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "calib/geometry/patch_mesh.h"
#include "devices/display/gl_context.h"
#include "tests/gl/bent_frames.h"
#include "tests/gl/mesh_count.h"
#include "viewer/tiles/tile_layout.h"

namespace pixelflex::viewer {
namespace {

using devices::Size;
using testing::depthInDisplay;
using testing::displayOf;
using testing::kFrame;
using testing::Model;
using testing::Place;
using testing::projectorOf;

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

}  // namespace
}  // namespace pixelflex::viewer
