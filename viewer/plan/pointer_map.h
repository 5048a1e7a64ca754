#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "calib/geometry/projector_mapping.h"
#include "viewer/plan/wall_plan.h"

namespace pixelflex::viewer {

/// From where the pointer is on a projector's frame, or on the wall, to the desktop: the warp run backwards.
class PointerMap {
 public:
  PointerMap(const WallPlan& wall, devices::Size desktop);

  /// The desktop pixel under a point of a projector's frame (index as in WallPlan::projectors()), held inside the
  /// part of the desktop that is shown. None where the frame's ray misses the wall.
  [[nodiscard]] std::optional<glm::ivec2> fromProjector(std::size_t projector, glm::dvec2 pointInProjector) const;
  /// The same for a point of the wall.
  [[nodiscard]] glm::ivec2 fromWall(glm::dvec2 pointInWall) const;
  /// The nearest pixel of the part of the desktop that is shown.
  [[nodiscard]] glm::ivec2 hold(glm::dvec2 pointInDesktop) const;

 private:
  struct Screen {
    calib::ProjectorMapping mapping;
    std::optional<glm::ivec2> flatAt;
  };
  std::vector<Screen> screens_;
  calib::Homography desktopFromWall_;
  Placement placement_;
};

}  // namespace pixelflex::viewer
