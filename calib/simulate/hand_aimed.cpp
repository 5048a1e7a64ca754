#include "calib/simulate/hand_aimed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "calib/simulate/camera_fit.h"

namespace pixelflex::calib {

namespace {

using devices::Image8;

/// The nominal share of a projector: wall position of its top-left corner and millimetres per pixel.
struct Share {
  glm::dvec2 topLeft{0, 0};
  double scale = 1;
};

Share shareOf(const SimulatedWall& wall, std::size_t index) {
  const auto resolution = wall.rig().projectors[index].resolution;
  const glm::dvec2 size(resolution.width, resolution.height);
  const std::array corners{glm::dvec2(0, 0), glm::dvec2(size.x, 0), size, glm::dvec2(0, size.y)};
  glm::dvec2 centre(0);
  double perimeter = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto here = wall.wallFromProjector(index, corners.at(i));
    const auto next = wall.wallFromProjector(index, corners.at((i + 1) % corners.size()));
    if (!here || !next) return {};
    centre += 0.25 * *here;
    perimeter += glm::distance(*here, *next);
  }
  const double scale = perimeter / (2 * (size.x + size.y));
  return {centre - 0.5 * scale * size, scale};
}

/// One colour code of the desktop at a pixel position, interpolated; black outside.
double sampleAt(const Image8& desktop, glm::dvec2 point, int channel) {
  if (point.x < 0 || point.y < 0 || point.x > desktop.width() || point.y > desktop.height()) return 0;
  const glm::dvec2 last(desktop.width() - 1, desktop.height() - 1);
  const glm::dvec2 at = glm::clamp(point - 0.5, glm::dvec2(0), last);
  const glm::ivec2 low(at);
  const glm::ivec2 high = glm::min(low + 1, glm::ivec2(last));
  const glm::dvec2 part = at - glm::dvec2(low);
  const double top =
      glm::mix(1.0 * desktop.at(low.x, low.y, channel), 1.0 * desktop.at(high.x, low.y, channel), part.x);
  const double bottom =
      glm::mix(1.0 * desktop.at(low.x, high.y, channel), 1.0 * desktop.at(high.x, high.y, channel), part.x);
  return glm::mix(top, bottom, part.y);
}

Image8 cut(const Image8& desktop, const WallRect& rect, const Share& share, devices::Size size) {
  Image8 frame(size, 3);
  const glm::dvec2 pixelsPerUnit = glm::dvec2(desktop.width(), desktop.height()) / (rect.bottomRight - rect.topLeft);
  const bool grey = desktop.channels() < 3;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const glm::dvec2 onWall = share.topLeft + share.scale * glm::dvec2(x + 0.5, y + 0.5);
      const glm::dvec2 onDesktop = (onWall - rect.topLeft) * pixelsPerUnit;
      for (int c = 0; c < 3; ++c) {
        frame.at(x, y, c) = static_cast<std::uint8_t>(std::lround(sampleAt(desktop, onDesktop, grey ? 0 : c)));
      }
    }
  }
  return frame;
}

}  // namespace

WallRect litRect(const SimulatedWall& wall) {
  WallBounds bounds;
  const auto points = frameOutlines(wall.rig());
  for (const glm::dvec2 point : points) bounds.include(point);
  if (points.empty()) return {wall.rig().screenTopLeft, wall.rig().screenTopLeft + wall.rig().screenSize};
  return {bounds.low, bounds.high};
}

std::vector<Image8> handAimedFrames(const SimulatedWall& wall, const Image8& desktop, const WallRect& rect) {
  std::vector<Image8> frames;
  for (std::size_t i = 0; i < wall.projectorCount(); ++i) {
    frames.push_back(cut(desktop, rect, shareOf(wall, i), wall.rig().projectors[i].resolution));
  }
  return frames;
}

}  // namespace pixelflex::calib
