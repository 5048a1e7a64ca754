#include "calib/simulate/board.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "calib/simulate/placed_optics.h"

namespace pixelflex::calib {

namespace {

constexpr double kWhite = 0.9;
constexpr double kBlack = 0.06;
constexpr double kBorder = 0.75;  // white around the outer squares, of a square
constexpr double kInset = 2;      // camera pixels kept between the board and the picture's edge

/// How a person holds it: where in the picture, how much of the width it fills, and its tilt.
struct Hold {
  double x, y;  // of the picture
  double fill;  // of the picture's width
  double yaw, pitch, roll;
};

constexpr std::array<Hold, 15> kHolds{{{0.50, 0.50, 0.62, 0, 0, 0},
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

glm::dvec2 halfExtent(const Checkerboard& board) {
  return board.square * (0.5 * glm::dvec2(board.columns + 1, board.rows + 1) + kBorder);
}

std::optional<glm::dvec2> pixelOf(const Lens& lens, const BoardPose& pose, glm::dvec2 pointOnBoard) {
  const glm::dvec3 point = pose.cameraFromBoard * glm::dvec3(pointOnBoard, 0) + pose.middle;
  if (point.z <= 0) return std::nullopt;
  return lens.pixelFromRay(glm::dvec2(point) / point.z);
}

struct Bounds {
  glm::dvec2 low{1e9, 1e9};
  glm::dvec2 high{-1e9, -1e9};
  bool whole = true;  // every point of the outline is visible
};

Bounds outline(const Lens& lens, const Checkerboard& board, const BoardPose& pose) {
  constexpr int kSteps = 8;
  Bounds bounds;
  const glm::dvec2 half = halfExtent(board);
  for (int i = 0; i <= kSteps; ++i) {
    const double t = 2.0 * i / kSteps - 1;
    for (const glm::dvec2 part : {glm::dvec2(t, -1), glm::dvec2(t, 1), glm::dvec2(-1, t), glm::dvec2(1, t)}) {
      const auto pixel = pixelOf(lens, pose, part * half);
      bounds.whole = bounds.whole && pixel.has_value();
      if (!pixel) continue;
      bounds.low = glm::min(bounds.low, *pixel);
      bounds.high = glm::max(bounds.high, *pixel);
    }
  }
  return bounds;
}

/// How far the bounds must move to lie inside, or none when they are too large for it.
std::optional<glm::dvec2> moveInside(const Bounds& bounds, glm::dvec2 size) {
  if (!bounds.whole) return std::nullopt;
  const glm::dvec2 room = size - 2 * kInset - (bounds.high - bounds.low);
  if (room.x < 0 || room.y < 0) return std::nullopt;
  return glm::max(glm::dvec2(0), kInset - bounds.low) - glm::max(glm::dvec2(0), bounds.high - (size - kInset));
}

}  // namespace

BoardPose boardPose(const SimulatedCameraSpec& camera, const Checkerboard& board, int index) {
  assert(index >= 0);
  const Lens lens(camera.optics);
  const Hold hold = holdOf(index);
  const glm::dvec2 size(camera.size.width, camera.size.height);
  BoardPose pose{roomFromDevice({hold.yaw, hold.pitch, hold.roll}), {0, 0, 0}};
  double distance = 2 * halfExtent(board).x * camera.optics.focal / (hold.fill * size.x);
  // The board is kept this far from the edges at first, then moved until it just fits.
  glm::dvec2 target = size * (0.5 + 0.6 * (glm::dvec2(hold.x, hold.y) - 0.5));
  for (int step = 0; step < 60; ++step) {
    const auto ray = lens.rayFromPixel(target);
    pose.middle = distance * glm::dvec3(ray.value_or(glm::dvec2(0)), 1);
    const Bounds bounds = outline(lens, board, pose);
    const auto move = moveInside(bounds, size);
    if (!move) {
      distance *= 1.08;
      target += 0.2 * (0.5 * size - target);
    } else if (step < 30) {  // push outwards, to the edge that the person aims at
      const glm::dvec2 aim(hold.x, hold.y);
      const glm::dvec2 gapLow = bounds.low - kInset;
      const glm::dvec2 gapHigh = size - kInset - bounds.high;
      for (int axis = 0; axis < 2; ++axis) {
        if (aim[axis] == 0) target[axis] -= 0.7 * gapLow[axis];
        if (aim[axis] == 1) target[axis] += 0.7 * gapHigh[axis];
        if (aim[axis] > 0 && aim[axis] < 1) target[axis] += (*move)[axis];
      }
    } else if (glm::length(*move) > 0) {
      target += 1.2 * *move;
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
      corners.push_back(pixelOf(lens, pose, at * board.square).value_or(glm::dvec2(-1)));
    }
  }
  return corners;
}

namespace {

/// Reflectance of a board point, none beside the board.
std::optional<double> boardAt(const Checkerboard& board, glm::dvec2 pointOnBoard) {
  const glm::dvec2 half = halfExtent(board);
  if (std::abs(pointOnBoard.x) > half.x || std::abs(pointOnBoard.y) > half.y) return std::nullopt;
  const glm::dvec2 cell = pointOnBoard / board.square + 0.5 * glm::dvec2(board.columns + 1, board.rows + 1);
  if (cell.x < 0 || cell.y < 0 || cell.x >= board.columns + 1 || cell.y >= board.rows + 1) return kWhite;
  return (static_cast<int>(cell.x) + static_cast<int>(cell.y)) % 2 == 0 ? kBlack : kWhite;
}

/// Board point that a ray meets: the inverse of the pose, projective in the ray.
class BoardFromRay {
 public:
  explicit BoardFromRay(const BoardPose& pose)
      : boardFromCamera_(glm::transpose(pose.cameraFromBoard)),
        normal_(pose.cameraFromBoard[2]),
        middle_(pose.middle),
        offset_(glm::dot(normal_, middle_)) {}

  [[nodiscard]] glm::dvec2 operator()(glm::dvec2 ray) const {
    const glm::dvec3 along(ray, 1);
    return glm::dvec2(boardFromCamera_ * (along * (offset_ / glm::dot(normal_, along)) - middle_));
  }

 private:
  glm::dmat3 boardFromCamera_;
  glm::dvec3 normal_;
  glm::dvec3 middle_;
  double offset_;
};

}  // namespace

BoardRaster drawBoard(const SimulatedCameraSpec& camera, const Checkerboard& board, const BoardPose& pose) {
  constexpr int kFine = 6;
  BoardRaster raster{devices::ImageF(camera.size, 1), devices::ImageF(camera.size, 1)};
  const Lens lens(camera.optics);
  const BoardFromRay boardFromRay(pose);
  const Bounds bounds = outline(lens, board, pose);
  const glm::ivec2 low = glm::max(glm::ivec2(bounds.low) - 2, glm::ivec2(0));
  const glm::ivec2 high = glm::min(glm::ivec2(bounds.high) + 3, glm::ivec2(camera.size.width, camera.size.height));
  const auto pointAt = [&](int x, int y) {
    const auto ray = lens.rayFromPixel({x, y});
    return ray ? boardFromRay(*ray) : glm::dvec2(1e9);
  };
  for (int y = low.y; y < high.y; ++y) {
    glm::dvec2 topLeft = pointAt(low.x, y);
    glm::dvec2 bottomLeft = pointAt(low.x, y + 1);
    for (int x = low.x; x < high.x; ++x) {
      const glm::dvec2 topRight = pointAt(x + 1, y);
      const glm::dvec2 bottomRight = pointAt(x + 1, y + 1);
      double cover = 0;
      double reflectance = 0;
      for (int k = 0; k < kFine * kFine; ++k) {
        const double right = (k % kFine + 0.5) / kFine;
        const double down = (k / kFine + 0.5) / kFine;
        const glm::dvec2 top = topLeft + right * (topRight - topLeft);
        const auto here = boardAt(board, top + down * (bottomLeft + right * (bottomRight - bottomLeft) - top));
        if (!here) continue;
        cover += 1;
        reflectance += *here;
      }
      raster.cover.at(x, y) = static_cast<float>(cover / (kFine * kFine));
      raster.reflectance.at(x, y) = static_cast<float>(reflectance / (kFine * kFine));
      topLeft = topRight;
      bottomLeft = bottomRight;
    }
  }
  return raster;
}

}  // namespace pixelflex::calib
