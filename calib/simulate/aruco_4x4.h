#pragma once

#include <cstdint>
#include <span>

namespace pixelflex::calib {

/// The fifty markers of DICT_4X4_50: 4x4 modules each, row by row from the top left in the high bit; 1 is white. Around
/// them comes a border of one black module.
[[nodiscard]] std::span<const std::uint16_t> arucoPatterns4x4();

/// Whether a point of a marker is white; (0, 0) to (1, 1) is the black square with its border, y down.
[[nodiscard]] bool arucoIsWhite(int id, double x, double y);

}  // namespace pixelflex::calib
