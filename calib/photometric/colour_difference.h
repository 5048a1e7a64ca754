#pragma once

#include <glm/vec3.hpp>

namespace pixelflex::calib {

/// CIE 1976 L*a*b*: lightness 0 to 100, red-green, yellow-blue.
struct Lab {
  double lightness = 0, a = 0, b = 0;
};

/// Relative to `white`, which has lightness 100; XYZ in any linear unit, the same for both. Less than no light counts
/// as none.
[[nodiscard]] Lab labFromXyz(glm::dvec3 xyz, glm::dvec3 white);

/// Linear light in the primaries of sRGB, 1 being the white that the eye is adapted to. Channels of a camera whose own
/// primaries are not known count as these.
[[nodiscard]] Lab labFromLinearSrgb(glm::dvec3 light);

/// The colour difference CIEDE2000 with unit weights: below 1 side by side not seen, above 3 plain to see. After
/// Sharma, Wu and Dalal, The CIEDE2000 color-difference formula (2005).
[[nodiscard]] double deltaE2000(const Lab& first, const Lab& second);

}  // namespace pixelflex::calib
