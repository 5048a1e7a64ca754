#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>

#include "calib/simulate/board.h"
#include "calib/simulate/board_shape.h"
#include "calib/simulate/placed_optics.h"

namespace pixelflex::calib {

namespace {

constexpr double kInset = 2;  // camera pixels kept between the board and the picture's edge

/// How a person holds it: where in the picture, how much of the width it fills, and its tilt.
struct Hold {
  double x, y;  // of the picture
  double fill;  // of the picture's width
  double yaw, pitch, roll;
};

constexpr std::array<Hold, 15> kHolds{{{0.50, 0.50, 0.62, 4, -3, 5},
                                       {0.00, 0.00, 0.36, 12, -10, 3},
                                       {1.00, 0.00, 0.36, -12, -10, -4},
                                       {0.00, 1.00, 0.36, 12, 10, 2},
                                       {1.00, 1.00, 0.36, -12, 10, -3},
                                       {0.50, 0.45, 0.55, 35, 0, 6},
                                       {0.50, 0.55, 0.55, -35, 0, -6},
                                       {0.45, 0.50, 0.50, 0, 33, 4},
                                       {0.55, 0.50, 0.50, 0, -33, -5},
                                       {0.50, 0.00, 0.42, 20, 18, 0},
                                       {0.50, 1.00, 0.42, -20, -18, 88},
                                       {0.00, 0.50, 0.40, -25, 10, 10},
                                       {1.00, 0.50, 0.40, 25, -10, -12},
                                       {0.25, 0.30, 0.30, 28, -20, 20},
                                       {0.75, 0.70, 0.30, -22, 26, -25}}};

Hold holdOf(int index) {
  const auto i = static_cast<std::size_t>(index);
  if (i < kHolds.size()) return kHolds.at(i);
  // Further ones fill the gaps: additive recurrences with irrational steps spread evenly.
  const auto part = [index](double step) { return std::fmod(index * step, 1.0); };
  return {part(0.8191725134),           part(0.6710436067),           0.3 + 0.25 * part(0.5497004779),
          60 * part(0.4503599627) - 30, 60 * part(0.3689156832) - 30, 40 * part(0.2360679775) - 20};
}

/// How far the bounds must move to lie inside, or none when they are too large for it.
std::optional<glm::dvec2> moveInside(const BoardBounds& bounds, glm::dvec2 size) {
  if (!bounds.whole) return std::nullopt;
  const glm::dvec2 room = size - 2 * kInset - (bounds.high - bounds.low);
  if (room.x < 0 || room.y < 0) return std::nullopt;
  return glm::max(glm::dvec2(0), kInset - bounds.low) - glm::max(glm::dvec2(0), bounds.high - (size - kInset));
}

/// How far the bounds may still go towards the edges that the hold aims at (x or y of 0 or 1).
glm::dvec2 moveToEdge(const BoardBounds& bounds, glm::dvec2 size, const Hold& hold) {
  const glm::dvec2 aim(hold.x, hold.y);
  glm::dvec2 move(0);
  for (int axis = 0; axis < 2; ++axis) {
    if (aim[axis] == 0) move[axis] = kInset - bounds.low[axis];
    if (aim[axis] == 1) move[axis] = size[axis] - kInset - bounds.high[axis];
  }
  return move;
}

}  // namespace

BoardPose boardPose(const SimulatedCameraSpec& camera, const Checkerboard& board, int index) {
  constexpr int kOutwards = 40;  // steps that approach the edge
  constexpr int kSteps = 100;    // then steps that only bring the board back in
  assert(index >= 0);
  const Lens lens(camera.optics);
  const Hold hold = holdOf(index);
  const glm::dvec2 size(camera.size.width, camera.size.height);
  BoardPose pose{roomFromDevice({hold.yaw, hold.pitch, hold.roll}), {0, 0, 0}};
  double distance = 2 * halfExtentOf(board).x * camera.optics.focal / (hold.fill * size.x);
  glm::dvec2 target = size * (0.5 + 0.6 * (glm::dvec2(hold.x, hold.y) - 0.5));
  for (int step = 0; step < kSteps; ++step) {
    pose.middle = distance * glm::dvec3(lens.rayFromPixel(target).value_or(glm::dvec2(0)), 1);
    const BoardBounds bounds = boundsOfBoard(lens, board, pose);
    const auto back = moveInside(bounds, size);
    if (!back) {  // too large: a step back, and towards the middle
      distance *= 1.08;
      target += 0.2 * (0.5 * size - target);
    } else if (step < kOutwards) {
      target += 0.7 * moveToEdge(bounds, size, hold) + *back;
    } else if (*back != glm::dvec2(0)) {
      target += 1.2 * *back;
    } else {
      break;
    }
  }
  return pose;
}

std::vector<glm::dvec2> boardCorners(const SimulatedCameraSpec& camera, const Checkerboard& board,
                                     const BoardPose& pose) {
  const Lens lens(camera.optics);
  std::vector<glm::dvec2> corners;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      const glm::dvec2 at(column - 0.5 * (board.columns - 1), row - 0.5 * (board.rows - 1));
      corners.push_back(pixelFromBoard(lens, pose, at * board.square).value_or(glm::dvec2(-1)));
    }
  }
  return corners;
}

}  // namespace pixelflex::calib
