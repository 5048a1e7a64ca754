#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "calib/estimate/collineation.h"
#include "calib/estimate/projector_fit.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// What one place of the camera saw of one projector: projector pixel to undistorted camera pixel.
struct JointObservation {
  std::size_t place = 0;
  std::size_t projector = 0;
  std::vector<PointPair> points;  // `source` is the same number wherever the same point was seen
};

/// A wall photographed from several places.
struct JointProblem {
  std::vector<std::vector<PointPair>> fiducials;  // of each place: undistorted camera pixel to wall
  std::vector<devices::Size> resolutions;         // of each projector
  std::vector<JointObservation> observations;
};

/// The wall as seen from every place, all places, projectors and their points solved together (bundle adjustment on a
/// plane; calibration reference 5 and 6): camera pixels of the same projector point seen from several places must meet
/// in one wall point, which lies on a lens model of its projector; fiducials fix the wall's coordinates. Throws
/// EstimateError saying which place shares too little with the others or that four fiducials are wanting.
[[nodiscard]] std::vector<SurfaceFit> solvePlaces(const JointProblem& problem);

}  // namespace pixelflex::calib
