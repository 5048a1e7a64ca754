#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "calib/store/nudge.h"

namespace pixelflex::calib {

/// "p1:x=1.5,y=-0.5,roll=0.1,tl=2/-1": a projector and its correction; what is not named is zero. Throws
/// std::invalid_argument saying how to write it.
[[nodiscard]] std::pair<std::string, Nudge> parseNudgeArgument(std::string_view text);

}  // namespace pixelflex::calib
