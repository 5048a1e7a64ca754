#pragma once

#include <string>

#include "devices/image/image.h"

namespace pixelflex::calib {

/// A half-open box of pixels.
struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;
  [[nodiscard]] int width() const { return right - left; }
  [[nodiscard]] int height() const { return bottom - top; }
};

/// A part of a colour photograph, made no wider than `width` and as bright as paper shows well, as a JPEG "data:" URI.
/// `box` must lie within the photograph.
[[nodiscard]] std::string photographUri(const devices::Image8& photo, const PixelBox& box, int width);

/// A colour picture as it is, as a JPEG "data:" URI: for smooth ones.
[[nodiscard]] std::string jpegUri(const devices::Image8& picture);

/// A grey or red-green-blue-alpha picture as a PNG "data:" URI.
[[nodiscard]] std::string pictureUri(const devices::Image8& picture);

}  // namespace pixelflex::calib
