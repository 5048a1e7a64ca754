#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pixelflex::viewer {

/// Shows a test picture on the outputs of these projectors of the wall in `folder`, all of one X display or all
/// simulated (in the room that `pixelflex simulate --serve` photographs), until a signal or Escape ends it; `untilEof`:
/// or the end of standard input. Throws std::runtime_error, DisplayError.
void showTestPicture(const std::filesystem::path& folder, const std::vector<std::string>& projectors,
                     const std::string& picture, bool untilEof);

}  // namespace pixelflex::viewer
