#pragma once

#include <string>

#include "calib/procedure/summary.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// Text made safe inside HTML and SVG.
[[nodiscard]] std::string escaped(const std::string& text);

/// A colour that tells neighbouring projectors apart, CSS notation.
[[nodiscard]] std::string colourOf(std::size_t projector);

/// The wall as the audience sees it: footprints with names, the display rectangle, holes.
[[nodiscard]] std::string drawWall(const Calibration& calibration, const Summary& summary);

/// One projector's frame with its samples and, magnified a thousand times, what the model leaves of each.
[[nodiscard]] std::string drawResiduals(const ProjectorCalibration& projector);

/// A mask as a small grey picture, drawn with SVG rectangles so that the page needs no other file.
[[nodiscard]] std::string drawMask(const devices::Image16& mask);

}  // namespace pixelflex::calib
