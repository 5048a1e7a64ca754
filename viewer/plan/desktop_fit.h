#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "viewer/tiles/box.h"

namespace pixelflex::viewer {

enum class Fit {
  kLetterbox,  // the aspect is kept, what is left over stays black
  kStretch,    // the whole wall is filled
};

struct FitOptions {
  Fit fit = Fit::kLetterbox;
  std::optional<Box> region;  // the part of the desktop to show; none: all of it
};

/// Which part of a desktop is shown and where: desktop pixel p is at `shift + scale * p` on the wall's own desktop, the
/// one that it was calibrated for.
struct Placement {
  Box shown;  // desktop pixels
  glm::dvec2 scale{1, 1};
  glm::dvec2 shift{0, 0};

  [[nodiscard]] glm::dvec2 wallFromDesktop(glm::dvec2 p) const { return shift + scale * p; }
  [[nodiscard]] glm::dvec2 desktopFromWall(glm::dvec2 p) const { return (p - shift) / scale; }
  /// Where pixels fall on pixels: where the desktop's first one is.
  [[nodiscard]] std::optional<glm::ivec2> oneToOneAt() const;
  bool operator==(const Placement&) const = default;
};

/// As large as it can be and in the middle, by whole pixels of the wall's own desktop, so that what is not scaled is
/// not blurred either. Bars that come from the rounding of sides alone are filled. A region is cut to the
/// desktop, and the whole desktop is shown when nothing is left of it.
[[nodiscard]] Placement placeDesktop(devices::Size wall, devices::Size desktop, const FitOptions& options);

}  // namespace pixelflex::viewer
