#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "calib/capture/photographs.h"
#include "calib/geometry/projector_mapping.h"
#include "calib/geometry/screen_view.h"
#include "calib/store/calibration.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The border of a projector's frame as the camera sees it: what of the light ends there is this projector's own.
class FrameBorder {
 public:
  /// Places where another projector's frame ends as well are left out. `view`: as the undistorted camera sees the wall.
  FrameBorder(const ProjectorMapping& projector, const std::vector<ProjectorMapping>& others, const ScreenView& view,
              const CameraIntrinsics& camera);

  /// The part of the picture that leak() looks at.
  [[nodiscard]] PictureRegion region() const { return region_; }

  /// The light that this projector's black leaks over its white above black: how much darker it gets across the border
  /// in `black`, for how much in `white`, two pictures of linear light, the latter above black. None where too little
  /// of the border is seen, or its places disagree.
  [[nodiscard]] std::optional<double> leak(const devices::ImageF& black, const devices::ImageF& white) const;

 private:
  /// Pixels on either side, as many of both.
  struct Place {
    std::vector<glm::ivec2> inside;
    std::vector<glm::ivec2> outside;
  };
  std::vector<Place> places_;
  PictureRegion region_;
};

}  // namespace pixelflex::calib
