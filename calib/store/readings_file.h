#pragma once

#include <filesystem>
#include <vector>

#include "calib/store/store.h"

namespace pixelflex::calib {

/// Everything wrong with a file of 256 readings: rows `value,red,green,blue` with values 0 to 255 in order and finite,
/// non-negative light; one header row of words may come first.
[[nodiscard]] std::vector<Problem> checkReadings(const std::filesystem::path& file);

}  // namespace pixelflex::calib
