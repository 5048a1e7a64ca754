#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>

#include "calib/geometry/camera_mapping.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The 4x4 modules of a marker, row by row from its top left; true is white. Around them lies a black module, around
/// that white.
using MarkerModules = std::array<bool, 16>;

struct MarkerFit {
  std::array<glm::dvec2, 4> corners{};  // of the black square from its top left, clockwise, undistorted camera pixels
  glm::dvec2 centre{0, 0};              // where the diagonals meet, likewise
  double agreement = 0;                 // 1: the picture is this marker; 0: nothing of it is
};

/// Least squares of the whole marker, seen in perspective, blurred and unevenly lit, through the grey picture (codes)
/// around it: far better than its corners alone when modules are a few pixels wide. `corners`: roughly, raw pixels
/// (centres at +0.5), in the order of MarkerFit. None when it leaves them.
[[nodiscard]] std::optional<MarkerFit> fitMarker(const devices::Image8& grey, const CameraMapping& camera,
                                                 const MarkerModules& modules,
                                                 const std::array<glm::dvec2, 4>& corners);

}  // namespace pixelflex::calib
