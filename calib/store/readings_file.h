#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "calib/store/store.h"

namespace pixelflex::calib {

/// A projector's light as an instrument gave it: of each of the 256 codes, per channel, in any linear unit.
struct Readings {
  std::array<std::array<double, 256>, 3> light{};
  std::array<int, 256> line{};    // of the file, where each code was read
  std::vector<Problem> problems;  // with the text; the light is only complete when there are none
};

/// Rows `value,red,green,blue` with values 0 to 255 in order and finite, non-negative light. One header row of words
/// may come first; where it names value, red, green or blue, they must stand in this order. Empty rows and rows that
/// begin with # are skipped. Never throws, whatever the text.
[[nodiscard]] Readings readReadings(std::string_view csv, const std::string& file);

/// Everything wrong with the text of a file of readings.
[[nodiscard]] std::vector<Problem> checkReadings(const std::filesystem::path& file);

}  // namespace pixelflex::calib
