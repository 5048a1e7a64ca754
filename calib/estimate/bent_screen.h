#pragma once

#include <optional>
#include <span>

#include "calib/estimate/collineation.h"
#include "calib/estimate/projector_fit.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// A bent screen as a calibrated camera sees it: the camera's pose from fiducials (undistorted camera pixel to wall,
/// the wall unrolled), with a cylinder of this radius about a vertical axis; positive is hollow towards the audience,
/// negative bulging. The apex is the fiducials' mean. Throws EstimateError for fewer than four fiducials or when no
/// pose fits.
[[nodiscard]] SurfaceFit fitBentSurface(std::span<const PointPair> fiducials, const CameraIntrinsics& camera,
                                        double radius);

/// What a person knows of the radius has no sign: the better of hollow and bulging.
[[nodiscard]] SurfaceFit fitCylinder(std::span<const PointPair> fiducials, const CameraIntrinsics& camera,
                                     double radius);

/// How a screen that was said to be flat bends.
struct Bow {
  double radius = 0;     // wall units, signed as above
  double width = 0;      // wall units, of the part looked at
  double height = 0;     // wall units: how far the middle stands back (or, negative, forward) from a plane
  double flatError = 0;  // rms of a plane's fit: wall units for fiducials, projector pixels for a projector
  double bentError = 0;  // of the bent screen's
};

/// From six or more fiducials: the bend that explains them best. None when it explains them hardly better than a plane.
[[nodiscard]] std::optional<Bow> bowOfFiducials(std::span<const PointPair> fiducials, const CameraIntrinsics& camera);

/// From one projector's points (projector pixel to undistorted camera pixel).
[[nodiscard]] std::optional<Bow> bowOfProjector(std::span<const PointPair> points, devices::Size resolution,
                                                std::span<const PointPair> fiducials, const CameraIntrinsics& camera);

}  // namespace pixelflex::calib
