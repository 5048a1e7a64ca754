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

/// 256 rows `value,red,green,blue` in any linear unit, as readReadings takes them. The leak (code 0) is subtracted, the
/// rest normalised; noise that makes a curve fall is levelled by isotonic regression. Throws ResponseError: rows that
/// are wrong, curves that fall by more than noise does, or that are flat over more than a third of the codes at either
/// end (a meter below its threshold, or over its range).
[[nodiscard]] ResponseCurve parseReadings(std::string_view csv, const std::string& file);

/// What parseReadings reads back to an equal curve.
[[nodiscard]] std::string formatReadings(const ResponseCurve& curve);

/// Takes the noise out of measured curves: each code's light from a parabola through its neighbours, the more of them
/// the noisier the curve. Curves without noise (below 0.1 % from code to code) come back unchanged, kinks and all.
[[nodiscard]] ResponseCurve withoutNoise(const ResponseCurve& curve);

inline constexpr std::size_t kInverseEntries = 1024;

/// The gamma correction LUT (report 5.2): for light l, entry l^(1/2.2) * (kInverseEntries - 1) holds the device code
/// 0..1 that makes it; spacing by the root keeps dark tones apart. From code to light and back is the identity between
/// the readings' points. Inside a flat foot the highest code of it is taken, so that tones begin to rise at once; black
/// and white are codes 0 and 1 whatever the foot and the shoulder.
[[nodiscard]] std::vector<float> inverseResponse(const std::array<double, 256>& light);

}  // namespace pixelflex::calib
