#pragma once

#include <filesystem>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "calib/store/calibration.h"

namespace pixelflex::viewer {

/// Where a mirror stood when its projector's footprint was measured.
struct AimPose {
  glm::dvec2 counts{0, 0};  // pan, tilt
  glm::dvec2 centreInWall{0, 0};
};

/// How a footprint moves with its mirror, near where it is.
struct MirrorAim {
  glm::dmat2 wallFromCounts{1};  // wall units a count of pan (first column) and of tilt
  int measured = 0;              // directions, 0 to 2, that measured poses tell; the rest is the mirror's geometry

  /// Counts of pan and tilt that move the footprint so far, to whole counts.
  [[nodiscard]] glm::dvec2 countsFor(glm::dvec2 byInWall) const;
};

/// A mirror that turns by an angle turns the beam by twice as much, and a point straight ahead moves by that much of
/// the distance, which the projector's focal length and the size of its pixels on the wall give. Positive pan is taken
/// to be to the right, positive tilt up. `degreesPerCount` of pan and tilt.
[[nodiscard]] MirrorAim aimByGeometry(const calib::ProjectorCalibration& projector, glm::dvec2 degreesPerCount);

/// The least-squares map through what was measured; `geometry` where that does not say enough.
[[nodiscard]] MirrorAim aimByPoses(const MirrorAim& geometry, std::span<const AimPose> poses);

/// Where the middle of a projector's frame is on the wall.
[[nodiscard]] glm::dvec2 centreInWall(const calib::ProjectorCalibration& projector);

/// By projector, what presets with a calibration of their own tell: small moves, each calibrated and saved. Presets
/// that cannot be read tell nothing.
[[nodiscard]] std::map<std::string, std::vector<AimPose>> posesOfPresets(const std::filesystem::path& folder);

}  // namespace pixelflex::viewer
