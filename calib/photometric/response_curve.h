#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pixelflex::calib {

/// Readings that cannot be a projector's response; what() names file, line and cure.
class ResponseError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A projector's response: the light of each of the 256 codes, per channel, from 0 (code 0) to 1 (code 255), never
/// falling.
struct ResponseCurve {
  std::array<std::array<double, 256>, 3> light{};
  bool operator==(const ResponseCurve&) const = default;
};

/// 256 rows `value,red,green,blue` in any linear unit, an optional header row first. The leak (code 0) is subtracted,
/// the rest normalised; noise that makes a curve fall is levelled by isotonic regression. Throws ResponseError.
[[nodiscard]] ResponseCurve parseReadings(std::string_view csv, const std::string& file);

/// What parseReadings reads back to an equal curve.
[[nodiscard]] std::string formatReadings(const ResponseCurve& curve);

inline constexpr std::size_t kInverseEntries = 1024;

/// The gamma correction LUT (report 5.2): for light l, entry l^(1/2.2) * (kInverseEntries - 1) holds the device code
/// 0..1 that makes it; spacing by the root keeps dark tones apart. From code to light and back is the identity between
/// the readings' points; inside a flat foot the highest code of it is taken.
[[nodiscard]] std::vector<float> inverseResponse(const std::array<double, 256>& light);

}  // namespace pixelflex::calib
