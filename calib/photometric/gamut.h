#pragma once

#include <array>
#include <span>
#include <vector>

namespace pixelflex::calib {

using Matrix3 = std::array<double, 9>;  // row major

/// How one projector makes the common colours.
struct ColourMatch {
  Matrix3 colour{1, 0, 0, 0, 1, 0, 0, 0, 1};  // its linear light from the wall's: T
  double scale = 1;                           // luminance of the common white as it makes it
  double kept = 1;                            // of the luminance of its own white
};

/// Colours that all projectors can make: M T = scale * target for each, where M are its primaries.
struct CommonGamut {
  Matrix3 target{};  // columns: red, green and blue; their sum, the common white, has luminance 1
  std::vector<ColourMatch> projectors;
  double desaturation = 0;  // of the mean primary that lost most: 0 none, 1 grey
};

/// Weights of red, green and blue for cameras whose own weights are not known (ITU-R BT.709).
inline constexpr std::array<double, 3> kCameraLuminance = {0.2126, 0.7152, 0.0722};

/// Columns of `primaries` are the colours of a projector's full red, green and blue above its black, in any linear
/// space that is the same for all (a camera's channels, or XYZ); `luminance` weighs that space's components. The common
/// white is the mean of the projectors' whites, the common primaries are the means, each drawn towards white just until
/// every projector makes it. Every projector stays as bright as its scarcest channel allows: levels are for the
/// luminance target to match, from white maps multiplied with `kept`. No colour of the desktop leaves 0..1 in any
/// projector. Projectors that are alike get the identity. Throws LightError: primaries that do not span colour, or that
/// have too little in common.
[[nodiscard]] CommonGamut commonGamut(std::span<const Matrix3> primaries,
                                      const std::array<double, 3>& luminance = kCameraLuminance);

}  // namespace pixelflex::calib
