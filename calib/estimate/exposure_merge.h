#pragma once

#include <array>
#include <span>

#include "calib/estimate/camera_response.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// Codes that tell light well: below, noise and steps of whole codes count; above, clipping is near.
inline constexpr int kDarkestCode = 20;
inline constexpr int kBrightestCode = 235;

/// Linear light per unit of exposure, three channels, from photographs of one still scene: each pixel from the
/// photographs that hold it in range, the longer exposures weighing more. Where all are too dark the longest tells,
/// where all are too bright the shortest, which is then a lower bound. At least one photograph; all colour, of one
/// size.
[[nodiscard]] devices::ImageF mergeExposures(std::span<const ExposedPhoto> photos, const CameraResponse& camera);

/// Light of an evenly lit patch.
struct PatchLight {
  std::array<double, 3> light{};      // mean over the patch, per channel of the camera
  std::array<double, 3> deviation{};  // of that mean, from the spread over the patch and from whole codes
  double clipped = 0;                 // part of the patch that is too bright for the shortest exposure
};

[[nodiscard]] PatchLight patchLight(std::span<const ExposedPhoto> photos, const CameraResponse& camera);

}  // namespace pixelflex::calib
