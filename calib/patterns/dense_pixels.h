#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "calib/patterns/dense_pattern.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The light of one projector in the photographs of black and white.
struct FrameLight {
  double full = 0;       // white above black where the frame is brightest, in codes of 0..255
  double blackMean = 0;  // of the whole photograph, likewise
  double whiteMean = 0;
};
[[nodiscard]] FrameLight measureFrameLight(const devices::Image8& black, const devices::Image8& white);

/// Which projector point lights each camera pixel, and what became of the others.
struct DensePixels {
  devices::ImageF points;          // two channels: projector x and y seen at the pixel's centre; NaN where unknown
  std::int64_t lit = 0;            // pixels within the frame; all others below are among them
  std::int64_t saturated = 0;      // white is clipped
  std::int64_t faint = 0;          // the wave hardly moves: hidden or blurred
  std::int64_t contradicting = 0;  // no wave, or it disagrees with the code
  glm::dvec2 shift{0, 0};  // of the waves against the codes, projector pixels modulo the period: the camera's move
  bool cutOff = false;     // the frame reaches the photograph's border

  [[nodiscard]] bool known(int x, int y) const { return points.at(x, y, 0) == points.at(x, y, 0); }
};

/// Decodes every pixel by itself. The photographs are in the order of densePatterns and of one size, three channels.
[[nodiscard]] DensePixels readPixels(const std::vector<devices::Image8>& photos, const DenseLayout& layout,
                                     const FrameLight& light);

/// Forgets pixels whose neighbours are unknown or do not continue them (borders of what stands before the wall), and
/// those so near the frame's border that they are lit in part only.
void keepContinuous(DensePixels& pixels, const DenseLayout& layout);

/// Camera pixels per projector pixel, the median; 0 when nothing is known.
[[nodiscard]] double cameraScaleOf(const DensePixels& pixels);

}  // namespace pixelflex::calib
