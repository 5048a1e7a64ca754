#pragma once

#include <string>
#include <vector>

#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// Where two projectors light the same part of the wall.
struct Seam {
  std::string first, second;   // names, in the calibration's order
  double overlapPercent = 0;   // of the smaller of the two footprints
  double sharedPercent = 0;    // of the overlap, lit by a third projector as well
  bool insideDisplay = false;  // whether any of it shows the desktop; what follows is 0 if not
  double narrowest = 0;        // of the blend, desktop pixels, between a tenth and nine tenths of its length
  double expectedRms = 0;      // expected seam error, in pixels of the coarser projector
  double expectedWorst = 0;    // not exceeded at 95 % of the calibrations, where the overlap is worst
  double densityRatio = 1;     // of the denser projector to the coarser, in pixels a wall unit, at least 1
};

/// All overlaps, computed from the calibration alone. The expected seam error at a wall point w combines what the
/// samples show and what they cannot show:
///
///   e(w)^2 = |m_A(w) - m_B(w)|^2 - n_A(w) - n_B(w)  +  v_A(w) + v_B(w)
///
/// m is the mean of the samples' residuals around w (Gaussian window of 0.75 sample spacings): where the model bends
/// away from what was measured, both projectors' lights part by the difference. n is the variance that such a mean has
/// from the samples' noise alone. v is the variance of the fitted model: FitQuality::deviation squared (from the rms
/// and the numbers of samples and unknowns where that is not known, or a residual spline follows the lens), spread over
/// the frame by the leverage of a quadratic fit to the samples' places, so that it grows towards the border as a
/// model's does. What both projectors share (the camera's lens, the fiducials) moves both alike and makes no seam; it
/// does not enter. A shift of all points of one projector alike would make one, but no residual shows it: it does not
/// enter either. Corrections by hand count as right.
[[nodiscard]] std::vector<Seam> findSeams(const Calibration& calibration);

}  // namespace pixelflex::calib
