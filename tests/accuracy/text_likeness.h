#pragma once

#include <filesystem>

#include "devices/image/image.h"

namespace pixelflex::calib {

/// A desktop full of a picture of text, four channels.
[[nodiscard]] devices::Image8 textDesktop(const devices::Image8& text, devices::Size size);

/// Structural similarity of two pictures of one channel in codes 0 to 255 (Wang, Bovik, Sheikh and Simoncelli 2004): an
/// 11 x 11 Gaussian window of sigma 1.5, its mean over all windows that lie wholly in the picture.
[[nodiscard]] double structuralSimilarity(const devices::ImageF& first, const devices::ImageF& second);

/// The same of what the audience sees of a desktop with what it was to show: luminance at the desktop's size, `white`
/// of it a white desktop's, as sRGB codes.
[[nodiscard]] double likenessToDesktop(const devices::ImageF& luminance, double white, const devices::Image8& desktop);

}  // namespace pixelflex::calib
