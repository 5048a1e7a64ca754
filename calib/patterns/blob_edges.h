#pragma once

#include <glm/vec2.hpp>

#include "calib/patterns/blob_grid.h"

namespace pixelflex::calib {

/// How the photograph of white agrees with where the blobs say that the frame ends.
struct FrameEdges {
  int sides = 0;           // of the frame's four that are seen
  double blur = 0;         // sigma of the edge's softness, camera pixels
  glm::dvec2 shift{0, 0};  // of the lit frame against the blobs, raw pixels; needs three sides
};
[[nodiscard]] FrameEdges measureEdges(const FrameLight& frame, const Grid& grid, const BlobLayout& layout);

}  // namespace pixelflex::calib
