#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "viewer/renderer/output_plan.h"
#include "viewer/tiles/tile_layout.h"

namespace pixelflex::viewer {

/// A corner as the GPU gets it: three of them a triangle, texels counted from the tile's own corner so that a float
/// keeps its precision on a large desktop.
struct TileVertex {
  float x = 0, y = 0;           // projector pixels
  float uw = 0, vw = 0, w = 1;  // texels of the tile, times w
  std::int32_t layer = 0;
};

/// Vertices [first, first + count) of a list of triangles.
struct VertexRun {
  std::int32_t first = 0;
  std::int32_t count = 0;
};

/// A projector's warp mesh, unrolled triangle by triangle, and what of it a damaged part of the desktop touches.
class MeshFootprint {
 public:
  MeshFootprint() = default;
  /// Throws RendererError when the mesh is not sound: an index or layer out of range, a weight that is not positive.
  MeshFootprint(const OutputPlan& plan, const TileLayout& layout);

  /// The smallest box of projector pixels that holds every pixel whose colour may depend on these desktop pixels, the
  /// filter's reach included; empty when none does.
  [[nodiscard]] Box touchedBy(const Box& desktopBox) const;

  /// The triangles that may cover a pixel of this box.
  [[nodiscard]] std::vector<VertexRun> trianglesIn(const Box& projectorBox) const;

  [[nodiscard]] std::span<const TileVertex> vertices() const { return vertices_; }
  /// The tiles that the mesh reads, each once.
  [[nodiscard]] const std::vector<int>& layers() const { return layers_; }

 private:
  struct Bounds {
    float left = 0, top = 0, right = 0, bottom = 0;
  };
  struct Patch {
    Bounds inDesktop;
    std::size_t firstTriangle = 0;
    std::size_t triangleCount = 0;
    glm::ivec2 origin{0, 0};  // desktop position of the tile's texel corner (0, 0)
  };
  void addPatch(const OutputPlan& plan, const WarpPatch& patch, const TileLayout& layout);
  [[nodiscard]] Bounds reachOf(const Box& desktopBox) const;
  [[nodiscard]] static bool overlap(const Bounds& a, const Bounds& b);
  static void grow(Bounds& bounds, float x, float y);

  devices::Size resolution_;
  devices::Size desktop_;
  std::vector<TileVertex> vertices_;
  std::vector<Bounds> inDesktop_;    // per triangle
  std::vector<Bounds> inProjector_;  // per triangle
  std::vector<Patch> patches_;
  std::vector<int> layers_;
};

}  // namespace pixelflex::viewer
