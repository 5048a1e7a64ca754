#pragma once

#include <array>
#include <string>
#include <vector>

#include "calib/patterns/blob_pattern.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The photographs of one projector, indexed by Pattern; all of one size, three channels.
using PatternPhotos = std::array<devices::Image8, kPatternCount>;

/// The same without owning them: some may have been exchanged to find out whether a person did that.
using PatternPhotoRefs = std::array<const devices::Image8*, kPatternCount>;

/// Something wrong with photographs, in words that follow their files' names.
struct PhotoProblem {
  std::vector<Pattern> patterns;  // the photographs it is about, at least one
  std::string seen;               // what is in them: "over-exposed: 12 % of the lit area is saturated"
  std::string advice;             // what to do about it
  bool fatal = true;              // false: the measurement goes on without what is missing
};

[[nodiscard]] inline std::size_t indexOf(Pattern pattern) {
  return static_cast<std::size_t>(pattern);
}
[[nodiscard]] inline Pattern bitPattern(int bit) {
  return static_cast<Pattern>(static_cast<int>(Pattern::kBit0) + bit);
}

}  // namespace pixelflex::calib
