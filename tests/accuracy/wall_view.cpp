#include "tests/accuracy/wall_view.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "calib/simulate/blur.h"

namespace pixelflex::calib {
namespace {

constexpr double kEye = 2;             // desktop pixels, sigma
constexpr double kStretchDegrees = 1;  // along a border
constexpr double kClear = 16;          // projector pixels that a block keeps from a border to lie clear of it

devices::Size sizeOf(const Display& display, double scale) {
  return {static_cast<int>(std::lround(display.resolution.width / scale)),
          static_cast<int>(std::lround(display.resolution.height / scale))};
}

}  // namespace

WallView::WallView(const SimulatedWall& room, const Display& display, double scale)
    : room_(room),
      topLeft_(display.left, display.top),
      bottomRight_(display.right, display.bottom),
      scale_(scale),
      size_(sizeOf(display, scale)) {
  for (std::size_t i = 0; i < room.projectorCount(); ++i) findBorders(i);
  findBlocks();
}

devices::ImageF WallView::light(const std::vector<devices::Image8>& frames) const {
  return room_.audienceLight(frames, topLeft_, bottomRight_, size_);
}

devices::ImageF WallView::seen(const std::vector<devices::Image8>& frames) const {
  devices::ImageF picture = light(frames);
  blur(picture, gaussianKernel(kEye * kEye / (scale_ * scale_)));
  return picture;
}

glm::dvec2 WallView::viewFromWall(glm::dvec2 pointInWall) const {
  return (pointInWall - topLeft_) / (bottomRight_ - topLeft_) * glm::dvec2(size_.width, size_.height);
}

glm::dvec2 WallView::wallFromView(glm::dvec2 pointInView) const {
  return topLeft_ + pointInView / glm::dvec2(size_.width, size_.height) * (bottomRight_ - topLeft_);
}

void WallView::findBorders(std::size_t projector) {
  const devices::Size frame = room_.rig().projectors[projector].resolution;
  const glm::dvec2 size(frame.width, frame.height);
  addEdge(projector, {0, 0}, {size.x, 0});
  addEdge(projector, {size.x, 0}, size);
  addEdge(projector, size, {0, size.y});
  addEdge(projector, {0, size.y}, {0, 0});
}

/// Cuts what of an edge lies inside the view into stretches. Edges run clockwise: outward is to the left.
void WallView::addEdge(std::size_t projector, glm::dvec2 from, glm::dvec2 to) {
  const auto place = [&](double part) {
    return viewFromWall(room_.wallFromProjector(projector, glm::mix(from, to, part)).value());
  };
  const double length = glm::distance(place(0), place(1));
  const auto wanted = static_cast<std::size_t>(kStretchDegrees * pixelsPerDegree());
  BorderStretch stretch{.projector = projector, .at = {}, .outward = {}};
  for (double pixel = 0.5; pixel < length; ++pixel) {
    const glm::dvec2 at = place(pixel / length);
    const glm::dvec2 along = glm::normalize(place((pixel + 0.5) / length) - place((pixel - 0.5) / length));
    const bool inside = at.x >= 0 && at.y >= 0 && at.x < size_.width && at.y < size_.height;
    if (inside) {
      stretch.at.push_back(at);
      stretch.outward.emplace_back(along.y, -along.x);
    }
    if (stretch.at.size() == wanted) borders_.push_back(stretch);
    if (!inside || stretch.at.size() == wanted) stretch.at.clear(), stretch.outward.clear();
  }
}

void WallView::findBlocks() {
  for (int y = 0; y + kBlockPixels <= size_.height; y += kBlockPixels) {
    for (int x = 0; x + kBlockPixels <= size_.width; x += kBlockPixels) blocks_.push_back(blockAt(x, y));
  }
}

WallBlock WallView::blockAt(int x, int y) const {
  WallBlock block{.x = x, .y = y};
  const glm::dvec2 inWall = wallFromView(glm::dvec2(x, y) + 0.5 * kBlockPixels);
  for (std::size_t i = 0; i < room_.projectorCount(); ++i) {
    const auto p = room_.projectorFromWall(i, inWall);
    if (!p) continue;
    const devices::Size frame = room_.rig().projectors[i].resolution;
    const glm::dvec2 inside = glm::min(*p, glm::dvec2(frame.width, frame.height) - *p);
    const double depth = std::min(inside.x, inside.y);
    if (depth > 0) ++block.lit;
    if (std::abs(depth) < kClear) block.nearBorder = true;
    if (inside.x > frame.width / 3.0 && inside.y > frame.height / 3.0) block.central |= std::uint64_t{1} << i;
  }
  return block;
}

Display withoutRim(const Display& display) {
  const double pixel = (display.right - display.left) / display.resolution.width;
  Display inner{display.left + kRim * pixel, display.top + kRim * pixel, display.right - kRim * pixel,
                display.bottom - kRim * pixel, display.resolution};
  inner.resolution.width -= static_cast<int>(2 * kRim);
  inner.resolution.height -= static_cast<int>(2 * kRim);
  return inner;
}

devices::ImageF luminanceOf(const devices::ImageF& light) {
  devices::ImageF luminance(light.size(), 1);
  const auto from = light.samples();
  auto to = luminance.samples();
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i] = 0.2126F * from[3 * i] + 0.7152F * from[3 * i + 1] + 0.0722F * from[3 * i + 2];
  }
  return luminance;
}

}  // namespace pixelflex::calib
