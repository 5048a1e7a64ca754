#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "calib/geometry/footprint.h"
#include "calib/geometry/projector_mapping.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// A texture patch of the desktop, half-open, desktop pixels (report 5.1.4: at most 1024x1024).
struct DesktopPatch {
  int left = 0, top = 0, right = 0, bottom = 0;
};

struct MeshVertex {
  glm::dvec2 pointInProjector{0, 0};
  glm::dvec2 pointInDesktop{0, 0};
  double weight = 1;  // projective: interpolate pointInDesktop * weight and weight, then divide
};

/// A projector's part of one patch: triangles of three vertex numbers.
struct PatchTriangles {
  std::size_t patch = 0;  // index into the patches given
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Vertices are shared by the patches that meet in them, so the mesh has neither cracks nor T-junctions.
struct PatchMesh {
  std::vector<MeshVertex> vertices;
  std::vector<PatchTriangles> patches;
};

/// Wall to desktop pixels: the display rectangle stretched over its resolution.
[[nodiscard]] Homography desktopFromWall(const Display& display);

/// Report 5.1.4: each patch AND the projector's footprint (boolean operation), the interior filled with points,
/// Delaunay in projector space. The points are those of the smooth model, one every `spacing` projector pixels, with
/// the frame's border and the patches' borders as constraints. Empty when the projector lights nothing of the display.
/// Throws GeometryError.
[[nodiscard]] PatchMesh buildPatchMesh(const ProjectorMapping& mapping, const Display& display,
                                       std::span<const DesktopPatch> patches, double spacing = 16);

}  // namespace pixelflex::calib
