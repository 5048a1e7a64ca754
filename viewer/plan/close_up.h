#pragma once

#include <glm/mat3x3.hpp>
#include <optional>

#include "viewer/plan/wall_plan.h"

namespace pixelflex::viewer {

/// A part of the display as a picture of its own, for one projector that is much denser than the desktop: an inset.
struct CloseUp {
  Box part;                  // desktop pixels
  devices::Size resolution;  // of the picture: about the projector's own pixels
  bool operator==(const CloseUp&) const = default;
};

/// A projector has a close-up when it has more pixels each way than this times the desktop's.
inline constexpr double kDenseProjector = 1.3;

/// None for a projector that is not denser than that, or shows nothing of the display.
[[nodiscard]] std::optional<CloseUp> closeUpOf(const WallPlan& wall, std::size_t projector);

/// The rectangle of the wall that it shows.
[[nodiscard]] calib::Display displayOf(const CloseUp& closeUp, const calib::Display& display);

/// Clip coordinates of the whole display to those of the part.
[[nodiscard]] glm::dmat3 partFromDesktop(const CloseUp& closeUp, devices::Size desktop);

}  // namespace pixelflex::viewer
