#pragma once

#include <optional>
#include <vector>

#include "calib/estimate/camera_response.h"
#include "calib/estimate/vignetting.h"
#include "calib/geometry/camera_mapping.h"
#include "calib/geometry/projector_mapping.h"
#include "calib/geometry/screen_view.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The light of a projector's white over its frame, as a camera saw it: a lattice whose nodes stand in the middles of
/// equal cells.
struct LightField {
  devices::ImageF light;  // three channels of the camera, white minus black, full scale 255; 0 where it was not seen
  std::vector<glm::dvec2> inCamera;                          // raw pixels, a node each, row by row
  [[nodiscard]] glm::dvec2 inFrame(std::size_t node) const;  // 0..1 both ways
};

/// From photographs of black and white on this projector (three channels): every node is the mean of what the camera
/// sees of its cell. Saturated and unseen nodes stay 0. `screen`: as the undistorted camera sees it. `response`: what
/// the photographs' codes stand for.
[[nodiscard]] LightField measureLight(const devices::Image8& black, const devices::Image8& white,
                                      const ProjectorMapping& projector, const ScreenView& screen,
                                      const CameraMapping& camera, devices::Size lattice,
                                      const CameraResponse& response = linearCamera());

/// Its nodes as samples for estimateVignetting().
[[nodiscard]] std::vector<SeenLight> samplesOf(const LightField& field, std::size_t projector,
                                               const ProjectorMapping& mapping);

/// The field as a camera without vignetting would have seen it, smooth (smoothField).
[[nodiscard]] devices::ImageF withoutVignetting(const LightField& field, const CameraVignetting& vignetting);

}  // namespace pixelflex::calib
