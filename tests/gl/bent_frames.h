#pragma once

#include "calib/geometry/projector_mapping.h"
#include "calib/store/calibration.h"

namespace pixelflex::testing {

inline constexpr devices::Size kFrame{1024, 768};

/// What bends the picture of a keystoned projector: nothing, its lens, the screen, a residual spline, a nudge, or all.
enum class Model { kKeystone, kShortThrow, kBent, kResidual, kNudged, kAll };
[[nodiscard]] calib::ProjectorCalibration projectorOf(Model kind);

/// How its frame and the display lie.
enum class Place { kFrameInsideDisplay, kDisplayCutsFrame };
[[nodiscard]] calib::Display displayOf(Place place);

/// How far inside the display's border a pixel's centre is, desktop pixels; negative outside.
[[nodiscard]] double depthInDisplay(const calib::ProjectorMapping& mapping, const calib::Display& display, int x,
                                    int y);

}  // namespace pixelflex::testing
