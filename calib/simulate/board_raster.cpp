#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "calib/simulate/board.h"
#include "calib/simulate/board_shape.h"
#include "calib/simulate/parallel.h"

namespace pixelflex::calib {

namespace {

constexpr double kWhite = 0.9;
constexpr double kBlack = 0.06;

/// The board point that a ray meets: the inverse of the pose, projective in the ray.
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

/// What a pixel gathers.
struct Share {
  double cover = 0;
  double reflectance = 0;
};

class BoardPainter {
 public:
  BoardPainter(const SimulatedCameraSpec& camera, const Checkerboard& board, const BoardPose& pose)
      : board_(board), half_(halfExtentOf(board)), lens_(camera.optics), boardFromRay_(pose) {}

  /// Board points at the corners of the pixels of a row, from pixel `first` on.
  void pointsOfRow(int first, int y, std::vector<glm::dvec2>& points) const {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto ray = lens_.rayFromPixel({first + static_cast<double>(i), y});
      points[i] = ray ? boardFromRay_(*ray) : glm::dvec2(1e9);
    }
  }

  /// The pixel between four board points, averaged.
  [[nodiscard]] Share gather(glm::dvec2 topLeft, glm::dvec2 topRight, glm::dvec2 bottomLeft,
                             glm::dvec2 bottomRight) const {
    constexpr int kFine = 6;
    const glm::ivec2 square = squareOf(topLeft);
    if (isInside(square) && square == squareOf(topRight) && square == squareOf(bottomLeft) &&
        square == squareOf(bottomRight)) {
      return {1, isBlack(square) ? kBlack : kWhite};
    }
    Share share;
    for (int k = 0; k < kFine * kFine; ++k) {
      const double right = (k % kFine + 0.5) / kFine;
      const double down = (k / kFine + 0.5) / kFine;
      const glm::dvec2 top = topLeft + right * (topRight - topLeft);
      add(top + down * (bottomLeft + right * (bottomRight - bottomLeft) - top), share);
    }
    return {share.cover / (kFine * kFine), share.reflectance / (kFine * kFine)};
  }

 private:
  [[nodiscard]] glm::ivec2 squareOf(glm::dvec2 pointOnBoard) const {
    const glm::dvec2 cell = pointOnBoard / board_.square + 0.5 * glm::dvec2(board_.columns + 1, board_.rows + 1);
    return {glm::floor(glm::clamp(cell, glm::dvec2(-2), glm::dvec2(1000)))};
  }
  [[nodiscard]] bool isInside(glm::ivec2 square) const {
    return square.x >= 0 && square.y >= 0 && square.x <= board_.columns && square.y <= board_.rows;
  }
  [[nodiscard]] static bool isBlack(glm::ivec2 square) { return (square.x + square.y) % 2 == 0; }

  void add(glm::dvec2 pointOnBoard, Share& share) const {
    if (std::abs(pointOnBoard.x) > half_.x || std::abs(pointOnBoard.y) > half_.y) return;
    const glm::ivec2 square = squareOf(pointOnBoard);
    share.cover += 1;
    share.reflectance += isInside(square) && isBlack(square) ? kBlack : kWhite;
  }

  Checkerboard board_;
  glm::dvec2 half_;
  Lens lens_;
  BoardFromRay boardFromRay_;
};

}  // namespace

BoardRaster drawBoard(const SimulatedCameraSpec& camera, const Checkerboard& board, const BoardPose& pose) {
  BoardRaster raster{devices::ImageF(camera.size, 1), devices::ImageF(camera.size, 1)};
  const BoardPainter painter(camera, board, pose);
  const BoardBounds bounds = boundsOfBoard(Lens(camera.optics), board, pose);
  const glm::ivec2 low = glm::max(glm::ivec2(bounds.low) - 2, glm::ivec2(0));
  const glm::ivec2 high = glm::min(glm::ivec2(bounds.high) + 3, glm::ivec2(camera.size.width, camera.size.height));
  inTwoHalves(high.y - low.y, [&](int first, int last) {
    std::vector<glm::dvec2> above(static_cast<std::size_t>(high.x - low.x) + 1);
    std::vector<glm::dvec2> below(above.size());
    painter.pointsOfRow(low.x, low.y + first, above);
    for (int y = low.y + first; y < low.y + last; ++y) {
      painter.pointsOfRow(low.x, y + 1, below);
      for (int x = low.x; x < high.x; ++x) {
        const auto i = static_cast<std::size_t>(x - low.x);
        const Share share = painter.gather(above[i], above[i + 1], below[i], below[i + 1]);
        raster.cover.at(x, y) = static_cast<float>(share.cover);
        raster.reflectance.at(x, y) = static_cast<float>(share.reflectance);
      }
      std::swap(above, below);
    }
  });
  return raster;
}

}  // namespace pixelflex::calib
