#pragma once

#include <array>
#include <string>
#include <string_view>

#include "devices/image/image.h"

namespace pixelflex::viewer {

struct TestPicture {
  std::string_view name;   // in commands
  std::string_view label;  // on buttons
};
inline constexpr std::array kTestPictures = {TestPicture{"off", "Off"},     TestPicture{"name", "Which?"},
                                             TestPicture{"grid", "Grid"},   TestPicture{"focus", "Focus"},
                                             TestPicture{"white", "White"}, TestPicture{"red", "Red"},
                                             TestPicture{"green", "Green"}, TestPicture{"blue", "Blue"}};

/// Three channels of the resolution. "grid": lines every 64 pixels, the frame's border and diagonals; "focus": text
/// down to single pixels; "name": the projector's, as large as it fits; "off" is black. Throws std::invalid_argument
/// for pictures that are none.
[[nodiscard]] devices::Image8 drawTestPicture(std::string_view picture, const std::string& projector,
                                              devices::Size resolution);

}  // namespace pixelflex::viewer
