#pragma once

#include <vector>

#include "calib/patterns/blob_decoder.h"
#include "calib/patterns/blob_grid.h"

namespace pixelflex::calib {

/// A blob measured to a fraction of a pixel.
struct FittedBlob {
  DecodedBlob blob;
  glm::dvec2 pointInRaw{0, 0};  // roughly: of the spot
  double sigma = 0;             // of its light, projector pixels
  double amplitude = 0;         // of the projector's white
  double clipped = 0;           // share of its samples that are saturated
};

/// Second pass: a Gaussian in projector space, under the first pass's map. Blobs that do not look like one are left
/// out. `photo`: of all blobs; `light`: its light relative to white; `peak`: of the brightest; `usable`: not zero where
/// that light is right.
[[nodiscard]] std::vector<FittedBlob> refineBlobs(const devices::Image8& photo, const devices::ImageF& light,
                                                  double peak, const devices::Image8& usable, const Grid& grid,
                                                  const BlobLayout& layout, const CameraMapping& camera);

}  // namespace pixelflex::calib
