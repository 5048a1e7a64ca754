#include "calib/simulate/overlap.h"

#include <algorithm>

namespace pixelflex::calib {

namespace {

constexpr int kSteps = 24;

/// Walks the edge of `owner` at the far or near end of `axis` and notes where it lies in `other`.
void walkEdge(const ProjectorLight& owner, const ProjectorLight& other, int axis, bool farEnd, Overlap& overlap) {
  const glm::dvec2 own(owner.spec().resolution.width, owner.spec().resolution.height);
  const glm::dvec2 frame(other.spec().resolution.width, other.spec().resolution.height);
  for (int step = 0; step <= kSteps; ++step) {
    glm::dvec2 edge = own * (step / double{kSteps});
    edge[axis] = farEnd ? own[axis] : 0;
    const auto wall = owner.wallFromPixel(edge);
    const auto pixel = wall ? other.pixelFromWall(*wall) : std::nullopt;
    if (!pixel || (*pixel)[1 - axis] < 0 || (*pixel)[1 - axis] > frame[1 - axis]) continue;
    const double part = (*pixel)[axis] / frame[axis];
    overlap.least = std::min(overlap.least, farEnd ? part : 1 - part);
    overlap.most = std::max(overlap.most, farEnd ? part : 1 - part);
  }
}

Overlap overlapAlong(const ProjectorLight& first, const ProjectorLight& second, int axis) {
  Overlap overlap;
  walkEdge(first, second, axis, true, overlap);
  walkEdge(second, first, axis, false, overlap);
  return overlap;
}

}  // namespace

Overlap overlapSideBySide(const ProjectorLight& first, const ProjectorLight& second) {
  return overlapAlong(first, second, 0);
}

Overlap overlapOneAboveOther(const ProjectorLight& first, const ProjectorLight& second) {
  return overlapAlong(first, second, 1);
}

}  // namespace pixelflex::calib
