#pragma once

#include <filesystem>

#include "calib/store/calibration.h"
#include "tests/support_calibration/registration.h"

namespace pixelflex::calib {

/// The pipeline of the report as it stands (5.1.2, 5.1.3, 6.1), to compare with: photographs undistorted, blobs
/// thresholded and their weighted centres taken without regard to black, vignetting or perspective, carried to the wall
/// by the fiducials' collineation, and joined by Delaunay triangles over which the texture is affine. Reads
/// `captures`/NAME/*.png; takes the camera and the collineation from the calibration, which has them from the same
/// photographs. Means nothing outside the hull of a projector's blobs. Throws std::runtime_error when a projector shows
/// fewer than 50 blobs.
[[nodiscard]] MeantPlace meantByReportPipeline(const std::filesystem::path& captures, const Calibration& calibration);

}  // namespace pixelflex::calib
