#include "viewer/plan/pointer_map.h"

#include <algorithm>
#include <cmath>

#include "calib/geometry/patch_mesh.h"

namespace pixelflex::viewer {

PointerMap::PointerMap(const WallPlan& wall, devices::Size desktop) : desktop_(desktop) {
  calib::Display display = wall.display();
  display.resolution = desktop;
  desktopFromWall_ = calib::desktopFromWall(display);
  for (const auto* projector : wall.projectors()) {
    screens_.push_back({calib::ProjectorMapping(*projector), projector->flatAt});
  }
}

std::optional<glm::ivec2> PointerMap::fromProjector(std::size_t projector, glm::dvec2 pointInProjector) const {
  const auto& screen = screens_[projector];
  if (screen.flatAt) return hold(pointInProjector + glm::dvec2(*screen.flatAt));
  const auto inWall = screen.mapping.wallFromProjector(pointInProjector);
  if (!inWall) return std::nullopt;
  return fromWall(*inWall);
}

glm::ivec2 PointerMap::fromWall(glm::dvec2 pointInWall) const {
  return hold(desktopFromWall_.map(pointInWall));
}

glm::ivec2 PointerMap::hold(glm::dvec2 p) const {
  return {static_cast<int>(std::clamp(std::floor(p.x), 0.0, desktop_.width - 1.0)),
          static_cast<int>(std::clamp(std::floor(p.y), 0.0, desktop_.height - 1.0))};
}

}  // namespace pixelflex::viewer
