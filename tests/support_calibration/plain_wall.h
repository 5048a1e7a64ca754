#pragma once

#include <string>

#include "calib/store/calibration.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// A wall and its calibration with nothing to remark, built by hand: squares of 1000 x 1000 projector pixels at one
/// pixel a millimetre, side by side, each 850 to the right of the one before; 100 exact samples each; a camera of one
/// pixel a millimetre that looks straight on, with the wall's origin at its pixel (100, 50).
struct PlainWall {
  explicit PlainWall(int projectors = 2);
  Wall wall;
  Calibration calibration;
};

}  // namespace pixelflex::calib
