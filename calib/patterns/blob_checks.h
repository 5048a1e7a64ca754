#pragma once

#include <vector>

#include "calib/patterns/blob_edges.h"
#include "calib/patterns/blob_grid.h"
#include "calib/patterns/blob_refine.h"

namespace pixelflex::calib {

/// What is known of a projector's photographs once its blobs are numbered and measured.
struct BlobEvidence {
  const BlobLayout& layout;
  const CameraMapping& camera;
  const FrameLight& frame;
  const Spots& spots;
  const CodePhotos& codes;
  const Grid& grid;
  const FrameEdges& edges;
  const std::vector<FittedBlob>& blobs;
  double cameraScale = 0;  // camera pixels per projector pixel
  devices::Size photo;
};

/// Code photographs that are swapped, blurred, of something else, or taken from another place.
[[nodiscard]] std::vector<PhotoProblem> checkCodes(const BlobEvidence& evidence);

/// Blobs that are hidden, clipped, unsharp or too faint to be measured well.
[[nodiscard]] std::vector<PhotoProblem> checkBlobs(const BlobEvidence& evidence);

/// Why blobs are missing, in a few words; empty when none are.
[[nodiscard]] std::string explainMissing(const BlobEvidence& evidence);

}  // namespace pixelflex::calib
