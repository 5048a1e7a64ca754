#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "calib/geometry/desktop_view.h"
#include "calib/geometry/footprint.h"
#include "calib/geometry/projector_mapping.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// A texture patch of the desktop, half-open, desktop pixels (report 5.1.4: at most 1024x1024).
struct DesktopPatch {
  int left = 0, top = 0, right = 0, bottom = 0;
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

/// Report 5.1.4: each patch AND the projector's footprint (boolean operation), the interior filled with points,
/// Delaunay in projector space. The points are those of the smooth model, one every `spacing` projector pixels and
/// closer where the model bends, with the frame's border and the patches' borders as constraints: between them the mesh
/// keeps to the model within about a hundredth of a pixel. Empty when the projector lights nothing of the display.
/// Throws GeometryError.
[[nodiscard]] PatchMesh buildPatchMesh(const ProjectorMapping& mapping, const Display& display,
                                       std::span<const DesktopPatch> patches, double spacing = 16);

}  // namespace pixelflex::calib
