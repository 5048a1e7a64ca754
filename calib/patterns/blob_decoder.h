#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "calib/geometry/camera_mapping.h"
#include "calib/patterns/blob_pattern.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The photographs of one projector, indexed by Pattern; all of one size, three channels.
using PatternPhotos = std::array<devices::Image8, kPatternCount>;

struct DecodedBlob {
  int id = 0;                           // 1..100
  glm::dvec2 pointInUndistorted{0, 0};  // camera pixels after CameraMapping
  double confidence = 0;                // 0: a coin toss, 1: every bit certain
};

struct DecodedBlobs {
  std::vector<DecodedBlob> blobs;  // by rising id; each id at most once
  int located = 0;                 // spots of light found before they were told apart
  double cameraScale = 0;          // camera pixels per projector pixel
  double saturatedShare = 0;       // of the lit frame, in the photograph of white
  std::string hint;                // when blobs are missing: the probable cause and what to do; else empty
};

/// Photographs to correspondences. Black and white photographs are divided out (leak, vignetting), spots found, told
/// apart by their seven bits, checked against one homography, then each centre is fitted as a Gaussian in projector
/// space, where perspective cannot bias it (calibration reference 1.1, 1.3). Never throws for bad pictures: it finds
/// less and says why.
[[nodiscard]] DecodedBlobs decodeBlobs(const PatternPhotos& photos, const BlobLayout& layout,
                                       const CameraMapping& camera);

}  // namespace pixelflex::calib
