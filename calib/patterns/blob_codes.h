#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <vector>

#include "calib/patterns/blob_light.h"

namespace pixelflex::calib {

/// What a code photograph shows, against the photograph of all blobs.
struct CodePhoto {
  std::vector<double> ratio;  // at every spot of the blobs photograph, light relative to what is lit: 1 lit, 0 dark
  int spots = 0;              // seen in it
  double matched = 0;         // share of them that have a partner in the blobs photograph, after `shift`
  glm::dvec2 shift{0, 0};     // median of their displacement against the blobs photograph, raw pixels
  double brightness = 1;      // of what is lit, around its centre, relative to the blobs photograph
  double sharpness = 1;       // peak by surroundings of what is lit, likewise; below 1: more blurred
};
using CodePhotos = std::array<CodePhoto, kCodeBits>;

/// `sigma`: of a blob, camera pixels.
[[nodiscard]] CodePhoto readCode(const devices::ImageF& light, const devices::ImageF& blobsLight, const Spots& blobs,
                                 const FrameLight& frame, double sigma);

}  // namespace pixelflex::calib
