#include "calib/geometry/desktop_view.h"

#include <glm/geometric.hpp>

#include "calib/geometry/footprint.h"

namespace pixelflex::calib {
namespace {

/// What a straight edge shows in its middle.
glm::dvec2 shownInMiddle(const MeshVertex& a, const MeshVertex& b) {
  return (a.pointInDesktop * a.weight + b.pointInDesktop * b.weight) / (a.weight + b.weight);
}

}  // namespace

Homography desktopFromWall(const Display& display) {
  const glm::dvec2 scale{display.resolution.width / (display.right - display.left),
                         display.resolution.height / (display.bottom - display.top)};
  return Homography::scaling(scale) * Homography::translation({-display.left, -display.top});
}

DesktopView::DesktopView(const ProjectorMapping& mapping, const Display& display)
    : mapping_(mapping),
      desktop_(display.resolution),
      desktopFromWall_(desktopFromWall(display)),
      wallFromDesktop_(desktopFromWall_.inverse()),
      flatDesktopFromProjector_(desktopFromWall_ * mapping.flatWallFromProjector()),
      weightInMiddle_(
          flatDesktopFromProjector_.weight({mapping.resolution().width / 2.0, mapping.resolution().height / 2.0})) {}

std::optional<glm::dvec2> DesktopView::desktopFromProjector(glm::dvec2 pointInProjector) const {
  const auto inWall = mapping_.wallFromProjector(pointInProjector);
  return inWall ? std::optional(desktopFromWall_.map(*inWall)) : std::nullopt;
}

glm::dvec2 DesktopView::projectorFromDesktop(glm::dvec2 pointInDesktop) const {
  constexpr double kSnap = 0.05;
  auto point = mapping_.projectorFromWall(wallFromDesktop_.map(pointInDesktop));
  if (!point) throw GeometryError("a point of the display falls outside the projector's lens model");
  const glm::dvec2 corner(mapping_.resolution().width, mapping_.resolution().height);
  for (int axis = 0; axis < 2; ++axis) {
    if ((*point)[axis] < kSnap) (*point)[axis] = 0;
    if ((*point)[axis] > corner[axis] - kSnap) (*point)[axis] = corner[axis];
  }
  return *point;
}

MeshVertex DesktopView::vertex(glm::dvec2 pointInProjector, glm::dvec2 pointInDesktop) const {
  // Projective interpolation is exact for a homography when the weight is its third coordinate.
  return {pointInProjector, pointInDesktop, flatDesktopFromProjector_.weight(pointInProjector) / weightInMiddle_};
}

bool DesktopView::followsInFrame(const MeshVertex& a, const MeshVertex& b) const {
  const auto middle = desktopFromProjector((a.pointInProjector + b.pointInProjector) / 2.0);
  return !middle || glm::distance(shownInMiddle(a, b), *middle) < kTolerance;
}

bool DesktopView::followsOnDesktop(const MeshVertex& a, const MeshVertex& b) const {
  // The place of the edge that shows the middle between both ends.
  const glm::dvec2 place = (a.pointInProjector * a.weight + b.pointInProjector * b.weight) / (a.weight + b.weight);
  const glm::dvec2 exact = projectorFromDesktop((a.pointInDesktop + b.pointInDesktop) / 2.0);
  return glm::distance(place, exact) < kTolerance;
}

bool DesktopView::followsInCell(glm::dvec2 low, glm::dvec2 size) const {
  const auto follows = [&](glm::dvec2 p, glm::dvec2 q) {
    const auto a = desktopFromProjector(p);
    const auto b = desktopFromProjector(q);
    return !a || !b || followsInFrame(vertex(p, *a), vertex(q, *b));
  };
  const auto middle = desktopFromProjector(low + size / 2.0);
  if (!middle) return true;
  const double near = 4 * (size.x + size.y);  // desktop pixels, roughly: a cell reaches no further
  const bool beside =
      middle->x < -near || middle->y < -near || middle->x > desktop_.width + near || middle->y > desktop_.height + near;
  return beside || (follows(low, low + size) && follows(low + glm::dvec2(size.x, 0), low + glm::dvec2(0, size.y)));
}

}  // namespace pixelflex::calib
