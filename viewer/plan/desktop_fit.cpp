#include "viewer/plan/desktop_fit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>

namespace pixelflex::viewer {
namespace {

constexpr double kNarrowestBars = 1;  // pixels, of both together

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
  if (options.fit == Fit::kLetterbox) {
    const double largest = std::min(placement.scale.x, placement.scale.y);
    for (int axis = 0; axis < 2; ++axis) {
      if (room[axis] - largest * extent[axis] >= kNarrowestBars) placement.scale[axis] = largest;
    }
  }
  const glm::dvec2 corner = glm::floor((room - placement.scale * extent) / 2.0 + 1e-6);
  placement.shift = corner - placement.scale * glm::dvec2(placement.shown.left, placement.shown.top);
  return placement;
}

}  // namespace pixelflex::viewer
