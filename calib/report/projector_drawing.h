#pragma once

#include <string>

#include "calib/store/calibration.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// One projector's frame with an arrow at each sample, from where it was shown to where the model puts what was
/// measured, magnified so that most arrows are as long as the samples' spacing allows; with a rule that tells the
/// length in projector pixels.
[[nodiscard]] std::string drawResiduals(const ProjectorCalibration& projector);

/// Projector pixels per desktop pixel over one projector's frame, and between what bounds they lie.
struct DensityDrawing {
  std::string svg;  // empty where the model says nothing
  double least = 0, most = 0;
};
[[nodiscard]] DensityDrawing drawDensity(const ProjectorCalibration& projector, const Display& display);

/// A mask as a small grey picture.
[[nodiscard]] std::string drawMask(const devices::Image16& mask);

}  // namespace pixelflex::calib
