#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/patterns/blob_photos.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// From this code on a sample counts as saturated.
inline constexpr int kSaturatedCode = 250;

/// What the photographs of black and white tell of a projector: where its frame is and how bright.
struct FrameLight {
  devices::ImageF black;                         // mean of the channels, codes
  devices::ImageF range;                         // white - black
  devices::Image8 mask;                          // not zero where the frame is
  int left = 0, top = 0, right = 0, bottom = 0;  // the frame's box, half open
  std::int64_t area = 0;                         // camera pixels of the frame
  double level = 0;                              // median of the range within the frame, codes
  double saturatedShare = 0;                     // of the frame, in white
  glm::dvec2 saturatedAt{-1};                    // where, on average, raw pixels
  int pieces = 0;                                // it consists of: more than one when something stands before it
  bool cutOff = false;                           // reaches the photograph's border

  /// Side of a blob's cell, camera pixels, on average.
  [[nodiscard]] double cell() const;
};

/// Mean of the three channels, codes.
[[nodiscard]] devices::ImageF brightness(const devices::Image8& photo);

/// What is lit in white - black, without specks; none when nothing is.
[[nodiscard]] std::optional<FrameLight> findFrame(const PatternPhotoRefs& photos);

/// Camera pixels per projector pixel, from the photographs of black and white alone; 0 when nothing is lit.
[[nodiscard]] double cameraScaleOf(const devices::Image8& black, const devices::Image8& white,
                                   devices::Size resolution);

/// The frame without a rim of this many camera pixels, where blur mixes it with the dark beside it.
[[nodiscard]] devices::Image8 withoutRim(const FrameLight& frame, double rim);

/// A photograph's light relative to the projector's own white, 0..1 within its frame and 0 elsewhere.
[[nodiscard]] devices::ImageF relativeLight(const devices::Image8& photo, const FrameLight& frame);

/// The value that a share of them lies below; 0 of none.
[[nodiscard]] double percentile(std::vector<float> values, double share);

/// Brightness of every `step`-th pixel of every `step`-th row.
[[nodiscard]] std::vector<float> sampledBrightness(const devices::Image8& photo, int step);

/// Spots of light, and how bright they are.
struct Spots {
  std::vector<glm::dvec2> pointsInRaw;  // centre of light above half the peak
  double peak = 0;                      // nearly the brightest light within the frame
};
/// None when the light is noise rather than blobs.
[[nodiscard]] Spots findSpots(const devices::ImageF& light, const FrameLight& frame);

/// Mean of the light in the square of (2 reach + 1)^2 pixels around a point.
[[nodiscard]] double meanAround(const devices::ImageF& light, glm::dvec2 pointInRaw, int reach);

/// "upper left", "middle", … of a photograph.
[[nodiscard]] std::string placeInPhoto(glm::dvec2 pointInRaw, devices::Size photo);

}  // namespace pixelflex::calib
