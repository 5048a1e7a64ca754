#pragma once

#include <string>
#include <vector>

#include "calib/store/wall.h"

namespace pixelflex::viewer {

/// Shows a test picture on the outputs of these projectors, all of one X display, until a signal or Escape ends it;
/// `untilEof`: or the end of standard input.
/// Throws std::runtime_error, DisplayError.
void showTestPicture(const calib::Wall& wall, const std::vector<std::string>& projectors, const std::string& picture,
                     bool untilEof);

}  // namespace pixelflex::viewer
