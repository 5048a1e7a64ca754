#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "calib/simulate/rig.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// How the checkerboard is held: a board point (x, y, 0) in millimetres from the board's middle is at
/// cameraFromBoard * point + middle in the camera's frame.
struct BoardPose {
  glm::dmat3 cameraFromBoard{1.0};
  glm::dvec3 middle{0, 0, 1000};
};

/// The pose with this number: the first ones fill the picture, its corners included, at several distances and tilts of
/// up to 35 degrees; the whole board is always in the picture.
[[nodiscard]] BoardPose boardPose(const SimulatedCameraSpec& camera, const Checkerboard& board, int index);

/// Pixels of the inner corners, row by row from the board's top left.
[[nodiscard]] std::vector<glm::dvec2> boardCorners(const SimulatedCameraSpec& camera, const Checkerboard& board,
                                                   const BoardPose& pose);

/// The board in the picture, one channel each, averaged over every pixel's area.
struct BoardRaster {
  devices::ImageF cover;        // 0..1: part of the pixel that the board hides
  devices::ImageF reflectance;  // of the whole pixel: 0 where the board is not
};
[[nodiscard]] BoardRaster drawBoard(const SimulatedCameraSpec& camera, const Checkerboard& board,
                                    const BoardPose& pose);

}  // namespace pixelflex::calib
