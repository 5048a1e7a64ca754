#include "viewer/plan/wall_screens.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "calib/geometry/desktop_view.h"
#include "calib/geometry/footprint.h"

namespace pixelflex::viewer {
namespace {

Box shownBy(const calib::ProjectorCalibration& projector, const calib::Display& display) {
  if (projector.flatAt) {
    const glm::ivec2 at = *projector.flatAt;
    return {at.x, at.y, at.x + projector.resolution.width, at.y + projector.resolution.height};
  }
  const auto desktopOf = calib::desktopFromWall(display);
  const auto outline = calib::footprint(calib::ProjectorMapping(projector));
  glm::dvec2 low = desktopOf.map(outline.front());
  glm::dvec2 high = low;
  for (const auto& point : outline) {
    low = glm::min(low, desktopOf.map(point));
    high = glm::max(high, desktopOf.map(point));
  }
  const auto held = [](double value, int most) {
    return static_cast<int>(std::lround(std::clamp(value, 0.0, 1.0 * most)));
  };
  const auto [width, height] = display.resolution;
  return {held(low.x, width), held(low.y, height), held(high.x, width), held(high.y, height)};
}

// Along the side on which they overlap less; an inset stays on top of what surrounds it.
void halveOverlap(Box& a, Box& b) {
  const Box both = intersect(a, b);
  if (both.empty() || both == a || both == b) return;
  if (both.width() < both.height()) {
    const int middle = (both.left + both.right) / 2;
    (a.left < b.left ? a.right : a.left) = middle;
    (a.left < b.left ? b.left : b.right) = middle;
  } else {
    const int middle = (both.top + both.bottom) / 2;
    (a.top < b.top ? a.bottom : a.top) = middle;
    (a.top < b.top ? b.top : b.bottom) = middle;
  }
}

}  // namespace

std::vector<Box> screensOfProjectors(const WallPlan& wall) {
  std::vector<Box> screens;
  for (const auto* projector : wall.projectors()) {
    const Box box = intersect(shownBy(*projector, wall.display()), boxOf(wall.desktop()));
    if (!box.empty()) screens.push_back(box);
  }
  for (std::size_t i = 0; i < screens.size(); ++i) {
    for (std::size_t j = i + 1; j < screens.size(); ++j) halveOverlap(screens[i], screens[j]);
  }
  return screens;
}

}  // namespace pixelflex::viewer
