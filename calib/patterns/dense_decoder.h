#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "calib/geometry/camera_mapping.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

struct DenseSample {
  glm::dvec2 pointInProjector{0, 0};    // of the lattice
  glm::dvec2 pointInUndistorted{0, 0};  // camera pixels after CameraMapping
};

struct DenseSamples {
  std::vector<DenseSample> samples;  // row by row; each lattice point at most once
  int shown = 0;                     // points of the lattice
  double cameraScale = 0;            // camera pixels per projector pixel
  double saturatedShare = 0;         // of the lit frame, in the photograph of white
  std::string hint;                  // when something is wrong: the probable cause and what to do; else empty
};

/// Photographs to correspondences: one per picture of densePatterns(resolution), in that order, three channels each.
/// Every camera pixel tells which projector point lights it; around each point of a regular lattice a robust quadratic
/// through those pixels tells where in the camera it is seen. Never throws for bad pictures: it finds less and says
/// why.
[[nodiscard]] DenseSamples decodeDense(const std::vector<devices::Image8>& photos, devices::Size resolution,
                                       const CameraMapping& camera);

}  // namespace pixelflex::calib
