#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "devices/image/image.h"
#include "tests/accuracy/wall_view.h"

namespace pixelflex::calib {

// Figures of light on the wall. Pictures of luminance have one channel; all errors are relative to what is there.

/// The step across a stretch of border: of the profile at right angles to it, 4 to 28 desktop pixels to either side and
/// averaged along the stretch, the part that is neither even nor a slope. So light that changes slowly is no step, a
/// ramp much shorter than the profile is one.
struct BorderStep {
  double step = 0;
  glm::dvec2 at{0, 0};  // view pixels
  std::size_t projector = 0;
};
/// The largest; profiles that would leave the view are not looked at. 0 where there is no border.
[[nodiscard]] BorderStep largestStep(const WallView& view, const devices::ImageF& luminance);

/// Standard deviation over mean.
[[nodiscard]] double unevenness(const devices::ImageF& luminance);

/// The largest change within one degree of view, and where.
struct SteepPlace {
  double change = 0;
  glm::dvec2 at{0, 0};  // view pixels
};
[[nodiscard]] SteepPlace steepestPerDegree(const WallView& view, const devices::ImageF& luminance);

/// Mean luminance where few projectors leak against that where more of them do: the largest difference.
[[nodiscard]] double blackStep(const WallView& view, const devices::ImageF& luminance);

/// Luminance of black, of white, and of a grey that is `light` of white.
struct GreyBetween {
  const devices::ImageF& black;
  const devices::ImageF& white;
  const devices::ImageF& grey;
  double light = 0;
};
/// RMS error of the grey in the overlaps, against black and white there and with its mean error taken out.
[[nodiscard]] double banding(const WallView& view, const GreyBetween& luminance);

/// Mean of three channels over the middle of a projector's frame.
[[nodiscard]] glm::dvec3 colourOfProjector(const WallView& view, const devices::ImageF& light, std::size_t projector);
[[nodiscard]] glm::dvec3 meanColour(const devices::ImageF& light);

/// RMS over all pairs of colours of CIEDE2000, for eyes that are adapted to `white`.
[[nodiscard]] double colourDifference(const std::vector<glm::dvec3>& colours, glm::dvec3 white);

}  // namespace pixelflex::calib
