#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "calib/geometry/camera_mapping.h"
#include "calib/patterns/blob_pattern.h"
#include "calib/patterns/blob_photos.h"

namespace pixelflex::calib {

struct DecodedBlob {
  int id = 0;                           // 1..100
  glm::dvec2 pointInUndistorted{0, 0};  // camera pixels after CameraMapping
  double confidence = 0;                // 1: every bit certain; 0: known only by its place among the others
  double error = 0;                     // standard deviation of the centre by the fit, per axis, projector pixels
};

struct DecodedBlobs {
  std::vector<DecodedBlob> blobs;      // by rising id; each id at most once
  int located = 0;                     // spots of light found before they were told apart
  double cameraScale = 0;              // camera pixels per projector pixel
  double saturatedShare = 0;           // of the lit frame, in the photograph of white
  bool cutOff = false;                 // the lit frame reaches the photograph's border
  std::string hint;                    // when blobs are missing: the probable cause and what to do; else empty
  std::vector<PhotoProblem> problems;  // by photograph, the gravest first; empty when all is well

  /// Whether a problem says that nothing measured here may be used.
  [[nodiscard]] bool unusable() const;
};

/// Photographs to correspondences. Black and white photographs are divided out (leak, vignetting), spots found, told
/// apart by their seven bits and by their place in the grid, then each centre is fitted as a Gaussian in projector
/// space, where perspective cannot bias it (calibration reference 1.1, 1.3). Never throws for bad pictures: it finds
/// less and says why.
[[nodiscard]] DecodedBlobs decodeBlobs(const PatternPhotos& photos, const BlobLayout& layout,
                                       const CameraMapping& camera);

}  // namespace pixelflex::calib
