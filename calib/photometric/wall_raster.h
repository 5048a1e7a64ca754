#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "devices/image/image.h"

namespace pixelflex::calib {

/// A raster laid over the display area, on which light is measured: pixel (x, y) stands for the wall point
/// origin + pitch * (x + 0.5, y + 0.5).
struct WallRaster {
  glm::dvec2 origin{0, 0};  // wall units
  double pitch = 1;         // wall units per pixel
  devices::Size size;

  [[nodiscard]] glm::dvec2 wallFromRaster(glm::dvec2 pointInRaster) const { return origin + pitch * pointInRaster; }
  [[nodiscard]] glm::dvec2 rasterFromWall(glm::dvec2 pointInWall) const { return (pointInWall - origin) / pitch; }
};

/// What one projector does on a wall raster; every map has the raster's size, one channel and linear light. All maps
/// are smooth where they are not zero: photographs' noise is to be averaged away before.
struct ProjectorLightMaps {
  devices::ImageF white;  // luminance of its white above its black, any unit common to all projectors; 0 out of reach
  devices::ImageF black;  // luminance of its black, same unit; empty where it is not known
  devices::ImageF share;  // alpha of equation 7; the shares of a pixel sum to one, or to zero outside the display
};

/// The value of a map at a point of its raster: bilinear among the positive ones of the four pixels around it. So a
/// map keeps its height up to the border of its light and half a pixel beyond. None where all four are zero.
[[nodiscard]] std::optional<double> valueAt(const devices::ImageF& map, glm::dvec2 pointInRaster);

/// The same, or the nearest positive value within `reach` pixels.
[[nodiscard]] std::optional<double> valueNear(const devices::ImageF& map, glm::dvec2 pointInRaster, int reach);

}  // namespace pixelflex::calib
