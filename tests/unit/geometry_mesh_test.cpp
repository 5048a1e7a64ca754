#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <span>

#include "calib/geometry/patch_mesh.h"

namespace pixelflex::calib {
namespace {

constexpr devices::Size kFrame{1024, 768};

ProjectorModel model() {
  return {.projectorFromWall = {1.0e-3, 6e-5, -0.55, -4e-5, 0.98e-3, -0.38, 5e-5, 3e-5, 1},
          .centre = {530, 350},
          .scale = 1024,
          .radial = {-0.06, 0.02, 0},
          .tangential = {5e-4, -3e-4}};
}

std::vector<DesktopPatch> patchesOf(devices::Size desktop, int stride) {
  std::vector<DesktopPatch> patches;
  for (int y = 0; y < desktop.height; y += stride) {
    for (int x = 0; x < desktop.width; x += stride) {
      patches.push_back({x, y, std::min(x + stride, desktop.width), std::min(y + stride, desktop.height)});
    }
  }
  return patches;
}

class PatchMeshTest : public ::testing::Test {
 protected:
  PatchMesh build(const Display& display, int stride = 300) {
    patches_ = patchesOf(display.resolution, stride);
    return buildPatchMesh(mapping_, display, patches_);
  }
  static std::array<MeshVertex, 3> corners(const PatchMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    return {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]};
  }
  static double area(const std::array<MeshVertex, 3>& t) {
    const glm::dvec2 u = t[1].pointInProjector - t[0].pointInProjector;
    const glm::dvec2 v = t[2].pointInProjector - t[0].pointInProjector;
    return std::abs(u.x * v.y - u.y * v.x) / 2;
  }

  ProjectorMapping mapping_{model(), kFrame};
  std::vector<DesktopPatch> patches_;
};

const Display kLarger{-400, -300, 1800, 1300, {2200, 1600}};  // the whole frame lies inside
const Display kSmaller{100, 80, 900, 700, {1600, 1240}};      // cuts the frame on all sides

TEST_F(PatchMeshTest, CoversTheWholeFrameExactlyOnce) {
  const PatchMesh mesh = build(kLarger);
  double covered = 0;
  for (const auto& patch : mesh.patches) {
    for (const auto& triangle : patch.triangles) covered += area(corners(mesh, triangle));
  }
  EXPECT_NEAR(covered, double(kFrame.area()), 1e-6 * double(kFrame.area()));
}

TEST_F(PatchMeshTest, HasNoTJunctionsAndNoCracks) {
  // Every edge is shared by two triangles, or lies on the border once; border edges form closed chains.
  for (const Display& display : {kLarger, kSmaller}) {
    const PatchMesh mesh = build(display);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const auto& patch : mesh.patches) {
      for (const auto& t : patch.triangles) {
        for (std::size_t i = 0; i < 3; ++i) ++uses[std::minmax(t[i], t[(i + 1) % 3])];
      }
    }
    double borderLength = 0;
    for (const auto& [edge, count] : uses) {
      ASSERT_LE(count, 2);
      if (count == 1) {
        borderLength +=
            glm::length(mesh.vertices[edge.first].pointInProjector - mesh.vertices[edge.second].pointInProjector);
      }
    }
    // Of a frame that lies wholly inside the display only its own border is left.
    if (display == kLarger) {
      EXPECT_NEAR(borderLength, 2 * (1024 + 768), 1e-6);
    }
  }
}

TEST_F(PatchMeshTest, KeepsEveryTriangleInsideItsPatch) {
  const PatchMesh mesh = build(kSmaller, 300);
  ASSERT_GT(mesh.patches.size(), 10u);
  std::set<std::size_t> seen;
  for (const auto& part : mesh.patches) {
    EXPECT_TRUE(seen.insert(part.patch).second);
    const auto& patch = patches_[part.patch];
    for (const auto& triangle : part.triangles) {
      for (const auto& corner : corners(mesh, triangle)) {
        ASSERT_GE(corner.pointInDesktop.x, patch.left - 1e-6);
        ASSERT_LE(corner.pointInDesktop.x, patch.right + 1e-6);
        ASSERT_GE(corner.pointInDesktop.y, patch.top - 1e-6);
        ASSERT_LE(corner.pointInDesktop.y, patch.bottom + 1e-6);
      }
    }
  }
}

/// The desktop position that a mesh draws at the mean of some corners.
glm::dvec2 drawnAt(std::span<const MeshVertex> corners) {
  glm::dvec2 weighted{0, 0};
  double weight = 0;
  for (const auto& corner : corners) {
    weighted += corner.pointInDesktop * corner.weight;
    weight += corner.weight;
  }
  return weighted / weight;
}

/// The largest error in the middles of triangles and of their edges, desktop pixels.
double worstError(const PatchMesh& mesh, const ProjectorMapping& mapping, const Display& display) {
  double worst = 0;
  const auto look = [&](std::span<const MeshVertex> corners) {
    glm::dvec2 middle{0, 0};
    for (const auto& corner : corners) middle += corner.pointInProjector / static_cast<double>(corners.size());
    const auto exact = desktopFromWall(display).map(*mapping.wallFromProjector(middle));
    worst = std::max(worst, glm::length(drawnAt(corners) - exact));
  };
  for (const auto& patch : mesh.patches) {
    for (const auto& triangle : patch.triangles) {
      const std::array<MeshVertex, 4> t = {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]],
                                           mesh.vertices[triangle[2]], mesh.vertices[triangle[0]]};
      look(std::span(t).first(3));
      for (std::size_t i = 0; i < 3; ++i) look(std::span(t).subspan(i, 2));
    }
  }
  return worst;
}

TEST_F(PatchMeshTest, InterpolatesTheModelToAHundredthOfAPixel) {
  EXPECT_LT(worstError(build(kLarger), mapping_, kLarger), 0.01);
}

TEST_F(PatchMeshTest, IsFinerWhereALensBendsMore) {
  // A short-throw lens and a large frame, whose outline has a point every 60 pixels.
  constexpr devices::Size kLargeFrame{3840, 2160};
  const ProjectorModel wide{.projectorFromWall = {1.0 / 3840, 0, -0.5, 0, 1.0 / 3840, -0.28, 0, 1e-5, 1},
                            .centre = {1920, 1700},
                            .scale = 3840,
                            .radial = {-0.15, 0.02, 0}};
  const ProjectorMapping mapping(wide, kLargeFrame);
  const Display display{-1000, -1000, 5500, 4000, {6500, 5000}};
  const PatchMesh mesh = buildPatchMesh(mapping, display, patchesOf(display.resolution, 1020));
  EXPECT_LT(worstError(mesh, mapping, display), 0.015);
  // Without a lens nothing bends: two triangles for each 16 by 16 pixels, and what the borders add.
  ProjectorModel flat = wide;
  flat.radial = {};
  const PatchMesh coarse =
      buildPatchMesh(ProjectorMapping(flat, kLargeFrame), display, patchesOf(display.resolution, 1020));
  EXPECT_LT(coarse.vertices.size(), 36000U);
  EXPECT_GT(mesh.vertices.size(), coarse.vertices.size());
}

TEST_F(PatchMeshTest, IsEmptyWhenTheProjectorLightsNothingOfTheDisplay) {
  EXPECT_TRUE(build({5000, 5000, 6000, 6000, {1000, 1000}}).patches.empty());
}

TEST_F(PatchMeshTest, CutsTheDisplaysBorderWhereItIs) {
  const PatchMesh mesh = build(kSmaller);
  glm::dvec2 low{1e9};
  glm::dvec2 high{-1e9};
  for (const auto& part : mesh.patches) {
    for (const auto& triangle : part.triangles) {
      for (const auto& corner : corners(mesh, triangle)) {
        low = {std::min(low.x, corner.pointInDesktop.x), std::min(low.y, corner.pointInDesktop.y)};
        high = {std::max(high.x, corner.pointInDesktop.x), std::max(high.y, corner.pointInDesktop.y)};
      }
    }
  }
  EXPECT_DOUBLE_EQ(low.x, 0);
  EXPECT_DOUBLE_EQ(low.y, 0);
  EXPECT_DOUBLE_EQ(high.x, 1600);
  EXPECT_DOUBLE_EQ(high.y, 1240);
}

}  // namespace
}  // namespace pixelflex::calib
