#include "viewer/plan/pointer_map.h"

#include <algorithm>
#include <cmath>

#include "calib/geometry/patch_mesh.h"

namespace pixelflex::viewer {

PointerMap::PointerMap(const WallPlan& wall, devices::Size desktop) : placement_(wall.placementOf(desktop)) {
  desktopFromWall_ = calib::desktopFromWall(wall.displayOf(desktop));
  for (const auto* projector : wall.projectors()) {
    screens_.push_back({calib::ProjectorMapping(*projector), projector->flatAt});
  }
}

std::optional<glm::ivec2> PointerMap::fromProjector(std::size_t projector, glm::dvec2 pointInProjector) const {
  const auto& screen = screens_[projector];
  if (screen.flatAt) return hold(placement_.desktopFromWall(pointInProjector + glm::dvec2(*screen.flatAt)));
  const auto inWall = screen.mapping.wallFromProjector(pointInProjector);
  if (!inWall) return std::nullopt;
  return fromWall(*inWall);
}

glm::ivec2 PointerMap::fromWall(glm::dvec2 pointInWall) const {
  return hold(desktopFromWall_.map(pointInWall));
}

glm::ivec2 PointerMap::hold(glm::dvec2 p) const {
  const Box& shown = placement_.shown;
  return {static_cast<int>(std::clamp(std::floor(p.x), double(shown.left), shown.right - 1.0)),
          static_cast<int>(std::clamp(std::floor(p.y), double(shown.top), shown.bottom - 1.0))};
}

}  // namespace pixelflex::viewer
