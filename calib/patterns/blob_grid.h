#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "calib/geometry/camera_mapping.h"
#include "calib/geometry/homography.h"
#include "calib/patterns/blob_codes.h"

namespace pixelflex::calib {

/// A spot that is known by its number.
struct GridSpot {
  int id = 0;
  glm::dvec2 pointInRaw{0, 0};
  glm::dvec2 pointInUndistorted{0, 0};
  double confidence = 0;  // as in DecodedBlob
  std::size_t spot = 0;   // index into what was numbered
};

struct Grid {
  std::vector<GridSpot> spots;  // each id at most once
  Homography cameraFromProjector;
  std::optional<std::pair<int, int>> swappedBits;  // the codes make sense only with these two exchanged
};

/// Numbers the spots by their codes where these agree with one homography, then by their place among those neighbours
/// where codes are uncertain. No spots when the codes fit no grid. `cell`: side of a blob's cell, camera pixels.
[[nodiscard]] Grid numberSpots(const Spots& spots, const CodePhotos& codes, const BlobLayout& layout,
                               const CameraMapping& camera, double cell);

/// Camera from projector by least squares through the spots nearest to a blob, itself left out when `without` says so:
/// follows the bend of a wide lens where one homography for the whole frame cannot.
enum class Self { kWith, kWithout };
[[nodiscard]] Homography mapAround(int id, const Grid& grid, const BlobLayout& layout, Self self = Self::kWith);

}  // namespace pixelflex::calib
