#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "calib/capture/photographs.h"
#include "calib/geometry/projector_mapping.h"
#include "calib/geometry/screen_view.h"
#include "calib/store/calibration.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The camera's pixels that see the middle fifth of a projector's frame (a little more than that), always the same ones
/// from photograph to photograph.
class FramePatch {
 public:
  /// None when that middle is not wholly in the picture. `view`: as the undistorted camera sees the wall.
  [[nodiscard]] static std::optional<FramePatch> of(const ProjectorMapping& projector, const ScreenView& view,
                                                    const CameraIntrinsics& camera);

  /// Its pixels side by side, in one row.
  [[nodiscard]] devices::Image8 cut(const devices::Image8& photo) const;
  [[nodiscard]] PictureRegion region() const { return region_; }

 private:
  FramePatch() = default;
  PictureRegion region_;
  std::vector<std::size_t> pixels_;  // of the photograph, counted row by row
};

}  // namespace pixelflex::calib
