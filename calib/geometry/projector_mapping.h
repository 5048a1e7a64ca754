#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "calib/geometry/brown_lens.h"
#include "calib/geometry/homography.h"
#include "calib/geometry/residual_map.h"
#include "calib/geometry/screen_view.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// A projector's smooth model made usable: projector pixels to wall and back.
class ProjectorMapping {
 public:
  ProjectorMapping(const ProjectorModel& model, devices::Size resolution);
  /// With the correction by hand, if there is one: what the projector shows at p was measured at p before the nudge.
  explicit ProjectorMapping(const ProjectorCalibration& projector);

  /// Where a point of the frame (or a little outside it) lands on the wall. None where the lens model cannot be
  /// inverted or the ray misses the wall.
  [[nodiscard]] std::optional<glm::dvec2> wallFromProjector(glm::dvec2 pointInProjector) const;

  /// The frame's point that lights this wall point; may lie outside the frame. None for wall points so far outside that
  /// the lens polynomial would fold them back in, or behind the projector.
  [[nodiscard]] std::optional<glm::dvec2> projectorFromWall(glm::dvec2 pointInWall) const;

  /// The homography without the lens, wall from projector pixels, of the plane that touches the screen in the frame's
  /// middle: the source of projective texture weights.
  [[nodiscard]] Homography flatWallFromProjector() const;

  [[nodiscard]] devices::Size resolution() const { return resolution_; }
  [[nodiscard]] bool insideFrame(glm::dvec2 pointInProjector) const;

  /// Projector pixels per wall unit, the square root of the density of area, at a point of the frame.
  [[nodiscard]] double density(glm::dvec2 pointInProjector) const;
  /// The same, averaged over the frame.
  [[nodiscard]] double meanDensity() const;

 private:
  [[nodiscard]] std::optional<glm::dvec2> wallFromMeasured(glm::dvec2 pointInMeasured) const;

  [[nodiscard]] std::optional<glm::dvec2> idealFromMeasured(glm::dvec2 pointInMeasured) const;

  ScreenView view_;  // of the ideal, normalised image
  BrownLens lens_;
  ResidualMap residual_;
  glm::dvec2 centre_;
  double scale_;
  devices::Size resolution_;
  double largestRadius_;  // of the undistorted frame, with a margin
  double sign_;           // of the homogeneous weight in front of the projector
  glm::dvec2 middleInWall_{0, 0};
  Homography nudgedFromMeasured_;
  Homography measuredFromNudged_;
};

}  // namespace pixelflex::calib
