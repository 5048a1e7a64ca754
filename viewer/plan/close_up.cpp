#include "viewer/plan/close_up.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "calib/geometry/projector_mapping.h"

namespace pixelflex::viewer {
namespace {

/// Beyond what a projector shows, for the filter of the second pass; desktop pixels.
constexpr double kMargin = 4;
/// Of a picture's sides; what every graphics card can draw.
constexpr double kLongestSide = 8192;

glm::dvec2 unitOf(const calib::Display& display) {
  return {(display.right - display.left) / display.resolution.width,
          (display.bottom - display.top) / display.resolution.height};
}

/// The desktop pixels under the frame.
Box shownBy(const calib::ProjectorMapping& mapping, const calib::Display& display) {
  constexpr int kSteps = 32;
  glm::dvec2 low(display.resolution.width, display.resolution.height);
  glm::dvec2 high(0);
  const glm::dvec2 frame(mapping.resolution().width, mapping.resolution().height);
  for (int i = 0; i < (kSteps + 1) * (kSteps + 1); ++i) {
    const int row = i / (kSteps + 1);
    const auto onWall = mapping.wallFromProjector(frame * glm::dvec2(i % (kSteps + 1), row) / double{kSteps});
    if (!onWall) continue;
    const glm::dvec2 p = (*onWall - glm::dvec2(display.left, display.top)) / unitOf(display);
    low = glm::min(low, p - kMargin);
    high = glm::max(high, p + kMargin);
  }
  const Box around{static_cast<int>(std::floor(low.x)), static_cast<int>(std::floor(low.y)),
                   static_cast<int>(std::ceil(high.x)), static_cast<int>(std::ceil(high.y))};
  return intersect(around, boxOf(display.resolution));
}

}  // namespace

std::optional<CloseUp> closeUpOf(const WallPlan& wall, std::size_t index) {
  const auto& projector = *wall.projectors().at(index);
  if (projector.flatAt) return std::nullopt;
  const calib::ProjectorMapping mapping(projector);
  const glm::dvec2 unit = unitOf(wall.display());
  const double times = mapping.meanDensity() * std::sqrt(unit.x * unit.y);
  if (times < kDenseProjector) return std::nullopt;
  const Box part = shownBy(mapping, wall.display());
  if (part.empty()) return std::nullopt;
  const double scale = std::min(times, kLongestSide / std::max(part.width(), part.height()));
  return CloseUp{
      part, {static_cast<int>(std::ceil(scale * part.width())), static_cast<int>(std::ceil(scale * part.height()))}};
}

calib::Display displayOf(const CloseUp& closeUp, const calib::Display& display) {
  const glm::dvec2 unit = unitOf(display);
  return {.left = display.left + unit.x * closeUp.part.left,
          .top = display.top + unit.y * closeUp.part.top,
          .right = display.left + unit.x * closeUp.part.right,
          .bottom = display.top + unit.y * closeUp.part.bottom,
          .resolution = closeUp.resolution};
}

glm::dmat3 partFromDesktop(const CloseUp& closeUp, devices::Size desktop) {
  const glm::dvec2 whole(desktop.width, desktop.height);
  const glm::dvec2 low = 2.0 * glm::dvec2(closeUp.part.left, closeUp.part.top) / whole - 1.0;
  const glm::dvec2 high = 2.0 * glm::dvec2(closeUp.part.right, closeUp.part.bottom) / whole - 1.0;
  const glm::dvec2 scale = 2.0 / (high - low);
  const glm::dvec2 shift = -0.5 * (low + high) * scale;
  return {{scale.x, 0, 0}, {0, scale.y, 0}, {shift.x, shift.y, 1}};
}

}  // namespace pixelflex::viewer
