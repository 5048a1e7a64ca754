#pragma once

#include <optional>
#include <vector>

#include "calib/geometry/camera_mapping.h"
#include "calib/patterns/dense_fit.h"
#include "calib/patterns/dense_pixels.h"

namespace pixelflex::calib {

/// What was found at each point of a layout's lattice, row by row.
using DenseLattice = std::vector<std::optional<LocalMap>>;

/// Fits the map from projector to camera around every lattice point, on two threads.
[[nodiscard]] DenseLattice fitLattice(const DensePixels& pixels, double cameraScale, const DenseLayout& layout,
                                      const CameraMapping& camera);

/// Keeps the largest part of the lattice whose neighbours (across gaps, too) continue each other, and returns its share
/// of what was found: a frame is seen in one piece unless codes were misread or something stands before the wall.
double keepLargestPart(DenseLattice& lattice, const DenseLayout& layout);

}  // namespace pixelflex::calib
