#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "calib/simulate/board.h"
#include "calib/simulate/lens.h"

namespace pixelflex::calib {

/// Half the board's width and height in millimetres, its white border included.
[[nodiscard]] glm::dvec2 halfExtentOf(const Checkerboard& board);

/// Pixel of a board point (millimetres from the middle); none where the camera cannot see it.
[[nodiscard]] std::optional<glm::dvec2> pixelFromBoard(const Lens& lens, const BoardPose& pose,
                                                       glm::dvec2 pointOnBoard);

/// Where the board's outline lies in the picture.
struct BoardBounds {
  glm::dvec2 low{1e9, 1e9};
  glm::dvec2 high{-1e9, -1e9};
  bool whole = true;  // every point of the outline is visible
};
[[nodiscard]] BoardBounds boundsOfBoard(const Lens& lens, const Checkerboard& board, const BoardPose& pose);

}  // namespace pixelflex::calib
