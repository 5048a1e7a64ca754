#include "calib/procedure/frame_patch.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "calib/geometry/camera_mapping.h"

namespace pixelflex::calib {
namespace {

constexpr double kHalf = 0.24;       // of the frame's width and height: 23 % of its area
constexpr double kMostPixels = 3e4;  // noise is far below what else is uncertain
constexpr int kStepsOfSide = 8;

/// Raw pixels around the middle of the frame; empty when one of them is unknown.
std::vector<glm::dvec2> outlineOf(const ProjectorMapping& projector, const ScreenView& view,
                                  const CameraMapping& camera) {
  std::vector<glm::dvec2> outline;
  const glm::dvec2 frame(projector.resolution().width, projector.resolution().height);
  const std::vector<glm::dvec2> corners = {{-kHalf, -kHalf}, {kHalf, -kHalf}, {kHalf, kHalf}, {-kHalf, kHalf}};
  for (std::size_t side = 0; side < 4; ++side) {
    for (int step = 0; step < kStepsOfSide; ++step) {
      const double along = static_cast<double>(step) / kStepsOfSide;
      const glm::dvec2 inFrame = 0.5 + (1 - along) * corners[side] + along * corners[(side + 1) % 4];
      const auto inWall = projector.wallFromProjector(frame * inFrame);
      if (!inWall) return {};
      outline.push_back(camera.rawFromUndistorted(view.imageFromWall(*inWall)));
    }
  }
  return outline;
}

PictureRegion boundsOf(const std::vector<glm::dvec2>& outline) {
  const auto [left, right] = std::ranges::minmax(outline, {}, &glm::dvec2::x);
  const auto [top, bottom] = std::ranges::minmax(outline, {}, &glm::dvec2::y);
  return {static_cast<int>(std::floor(left.x)), static_cast<int>(std::floor(top.y)),
          static_cast<int>(std::ceil(right.x)), static_cast<int>(std::ceil(bottom.y))};
}

bool isInside(const std::vector<glm::dvec2>& outline, glm::dvec2 p) {
  bool inside = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const glm::dvec2 a = outline[i];
    const glm::dvec2 b = outline[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

}  // namespace

std::optional<FramePatch> FramePatch::of(const ProjectorMapping& projector, const ScreenView& view,
                                         const CameraIntrinsics& camera) {
  const auto outline = outlineOf(projector, view, CameraMapping(camera));
  if (outline.empty()) return std::nullopt;
  FramePatch patch;
  const auto& [left, top, right, bottom] = patch.region_ = boundsOf(outline);
  const auto [width, height] = camera.size;
  if (left < 0 || top < 0 || right > width || bottom > height) return std::nullopt;
  const double area = static_cast<double>(right - left) * (bottom - top);
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(area / kMostPixels))));
  for (int y = top; y < bottom; y += step) {
    for (int x = left; x < right; x += step) {
      if (!isInside(outline, {x + 0.5, y + 0.5})) continue;
      patch.pixels_.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(x));
    }
  }
  return patch.pixels_.empty() ? std::nullopt : std::optional(patch);
}

devices::Image8 FramePatch::cut(const devices::Image8& photo) const {
  assert(photo.channels() == 3);
  devices::Image8 row({static_cast<int>(pixels_.size()), 1}, 3);
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    std::ranges::copy(photo.samples().subspan(3 * pixels_[i], 3), row.samples().subspan(3 * i, 3).begin());
  }
  return row;
}

}  // namespace pixelflex::calib
