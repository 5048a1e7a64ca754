#pragma once

#include <glm/vec2.hpp>

#include "calib/geometry/camera_mapping.h"
#include "calib/geometry/projector_mapping.h"
#include "calib/geometry/screen_view.h"
#include "calib/patterns/blob_pattern.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// How far a projector's picture has moved since it was calibrated, in its own pixels. Without black and white
/// photographs a blob is found to about a tenth of a pixel.
struct Drift {
  int expected = 0;        // blobs that the photograph should show
  int found = 0;           // where one was, within half the distance to its neighbour
  glm::dvec2 shift{0, 0};  // median
  double rms = 0;
  double maximum = 0;
};

/// From one photograph of all blobs. `screen`: as the undistorted camera sees it.
[[nodiscard]] Drift measureDrift(const devices::Image8& photo, const BlobLayout& layout, const CameraMapping& camera,
                                 const ScreenView& screen, const ProjectorMapping& projector);

}  // namespace pixelflex::calib
