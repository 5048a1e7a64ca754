#pragma once

#include <array>
#include <span>

#include "devices/image/image.h"

namespace pixelflex::calib {

/// A photograph of a series in which only the exposure changes.
struct ExposedPhoto {
  double exposure = 1;  // exposure time, in any unit that the series shares
  devices::Image8 photo;
};

/// What light a camera's codes stand for, per channel: 0 at code 0, 1 at code 255, never falling. Channels have no
/// common scale.
struct CameraResponse {
  std::array<std::array<double, 256>, 3> light{};
  /// Expected relative error over codes 20 to 235, RMS: how much curves from two halves of the measurements
  /// disagree, and how much stronger smoothing changes them.
  double error = 0;
  /// By how much the photographs contradict the curve, relative, RMS: noise, and light that did not stay the same.
  double residual = 0;
};

/// A camera whose codes are proportional to light.
[[nodiscard]] CameraResponse linearCamera();

/// After Debevec and Malik, Recovering high dynamic range radiance maps from photographs (1997), with even patches of
/// the picture instead of pixels. The series, in any order, shows one still scene with bright and dark parts from too
/// dark to too bright; eight exposures doubling from one to the next serve well. Colour photographs of one size. Throws
/// EstimateError: fewer than three exposures, exposures that are alike or in the wrong order, nothing in range.
[[nodiscard]] CameraResponse estimateCameraResponse(std::span<const ExposedPhoto> photos);

}  // namespace pixelflex::calib
