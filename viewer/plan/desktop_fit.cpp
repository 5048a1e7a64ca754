#include "viewer/plan/desktop_fit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>

namespace pixelflex::viewer {
namespace {

/// Whether `extent` is `room` made smaller or larger, up to the rounding of all sides to whole pixels.
bool sameShape(glm::dvec2 room, glm::dvec2 extent) {
  const glm::dvec2 least = (room - 0.5) / (extent + 0.5);
  const glm::dvec2 most = (room + 0.5) / (extent - 0.5);
  return least.x <= most.y && least.y <= most.x;
}

}  // namespace

std::optional<glm::ivec2> Placement::oneToOneAt() const {
  const bool fits = scale == glm::dvec2(1, 1) && shift == glm::floor(shift);
  return fits ? std::optional(glm::ivec2(shift)) : std::nullopt;
}

Placement placeDesktop(devices::Size wall, devices::Size desktop, const FitOptions& options) {
  assert(wall.area() > 0 && desktop.area() > 0);
  Placement placement;
  placement.shown = intersect(options.region.value_or(boxOf(desktop)), boxOf(desktop));
  if (placement.shown.empty()) placement.shown = boxOf(desktop);
  const glm::dvec2 room(wall.width, wall.height);
  const glm::dvec2 extent(placement.shown.width(), placement.shown.height());
  placement.scale = room / extent;
  if (options.fit == Fit::kLetterbox && !sameShape(room, extent)) {
    placement.scale = glm::dvec2(std::min(placement.scale.x, placement.scale.y));
  }
  const glm::dvec2 corner = glm::floor((room - placement.scale * extent) / 2.0 + 1e-6);
  placement.shift = corner - placement.scale * glm::dvec2(placement.shown.left, placement.shown.top);
  return placement;
}

}  // namespace pixelflex::viewer
