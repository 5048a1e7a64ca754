#include "calib/simulate/board_shape.h"

#include <glm/common.hpp>

namespace pixelflex::calib {

namespace {

constexpr double kBorder = 0.75;  // white around the outer squares, of a square

}  // namespace

glm::dvec2 halfExtentOf(const Checkerboard& board) {
  return board.square * (0.5 * glm::dvec2(board.columns + 1, board.rows + 1) + kBorder);
}

std::optional<glm::dvec2> pixelFromBoard(const Lens& lens, const BoardPose& pose, glm::dvec2 pointOnBoard) {
  const glm::dvec3 point = pose.cameraFromBoard * glm::dvec3(pointOnBoard, 0) + pose.middle;
  if (point.z <= 0) return std::nullopt;
  return lens.pixelFromRay(glm::dvec2(point) / point.z);
}

BoardBounds boundsOfBoard(const Lens& lens, const Checkerboard& board, const BoardPose& pose) {
  constexpr int kSteps = 8;
  BoardBounds bounds;
  const glm::dvec2 half = halfExtentOf(board);
  for (int i = 0; i <= kSteps; ++i) {
    const double t = 2.0 * i / kSteps - 1;
    for (const glm::dvec2 part : {glm::dvec2(t, -1), glm::dvec2(t, 1), glm::dvec2(-1, t), glm::dvec2(1, t)}) {
      const auto pixel = pixelFromBoard(lens, pose, part * half);
      bounds.whole = bounds.whole && pixel.has_value();
      if (!pixel) continue;
      bounds.low = glm::min(bounds.low, *pixel);
      bounds.high = glm::max(bounds.high, *pixel);
    }
  }
  return bounds;
}

}  // namespace pixelflex::calib
