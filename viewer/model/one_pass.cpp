#include "viewer/model/one_pass.h"

#include <algorithm>
#include <array>
#include <glm/matrix.hpp>
#include <limits>
#include <stdexcept>

namespace pixelflex::viewer {

glm::dmat4 depthKeeping(const glm::dmat3& projectorFromDesktop) {
  const glm::dmat3 desktopFromProjector = glm::inverse(projectorFromDesktop);
  // For a point of the desktop at a corner of the frame, the new weight over the old is one over what the inverse
  // gives.
  const auto weightAt = [&](glm::dvec2 corner) { return 1 / (desktopFromProjector * glm::dvec3(corner, 1)).z; };
  const double sign = weightAt({0, 0}) < 0 ? -1 : 1;
  double least = std::numeric_limits<double>::max();
  for (const glm::dvec2 corner : std::array<glm::dvec2, 4>{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}}) {
    const double weight = sign * weightAt(corner);
    if (!(weight > 0)) throw std::invalid_argument("the frame reaches the wall's horizon");
    least = std::min(least, weight);
  }
  const glm::dmat3 h = projectorFromDesktop * (sign / least);
  return {{h[0].x, h[0].y, 0, h[0].z}, {h[1].x, h[1].y, 0, h[1].z}, {0, 0, 1, 0}, {h[2].x, h[2].y, 0, h[2].z}};
}

glm::dvec2 clipFromPixel(glm::dvec2 pixel, devices::Size frame) {
  return 2.0 * pixel / glm::dvec2(frame.width, frame.height) - 1.0;
}

}  // namespace pixelflex::viewer
