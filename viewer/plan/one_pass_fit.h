#pragma once

#include <vector>

#include "calib/store/calibration.h"
#include "viewer/model/model_renderer.h"
#include "viewer/plan/wall_plan.h"

namespace pixelflex::viewer {

/// Which measured features a projector's matrix is fitted to.
enum class Features {
  kAll,      // least squares: half the error where lenses bend
  kCorners,  // the four outermost, as in report 6.2
};

/// A projector's frame taken as a plane picture of the desktop.
struct OnePassFit {
  glm::dmat3 projectorFromDesktop{1};  // clip coordinates, see depthKeeping()
  double rms = 0;      // projector pixels from where the calibrated lens puts the same point of the wall,
  double maximum = 0;  // over all of the frame that shows the display
  LensLattice lens;    // what would make up for them
};

/// Above this many pixels at most, one pass alone is not good enough to be silent about.
inline constexpr double kLargestOnePassError = 0.5;

/// Throws PlanError when the projector has too few features or lights too little of the wall.
[[nodiscard]] OnePassFit fitOnePass(const calib::ProjectorCalibration& projector, const calib::Display& display,
                                    Features features);

/// Which eye's picture each of the wall's projectors shows: left and right by turns in every pair of a wall with
/// `stack: left-right`, of which the first named is the left one; else the middle between the eyes.
[[nodiscard]] std::vector<Eye> eyesOfProjectors(const WallPlan& wall);

/// The light of one projector, without the mesh of the desktop. An exact screen keeps its codes as they are.
[[nodiscard]] OutputPlan lightPlanOf(const WallPlan& wall, std::size_t projector);

/// The display as a window.
[[nodiscard]] WallWindow windowOf(const calib::Display& display);

}  // namespace pixelflex::viewer
