#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/report/wall_light.h"

namespace pixelflex::calib {

/// A line on the wall through the middle of the part of the display that two projectors both light, across it where it
/// is narrow, and on into what each lights alone.
struct OverlapLine {
  glm::dvec2 middle{0, 0};    // wall units
  glm::dvec2 along{1, 0};     // of length one
  double begin = 0, end = 0;  // of the line, wall units from the middle along it
  double overlapBegin = 0, overlapEnd = 0;
  [[nodiscard]] glm::dvec2 at(double distance) const { return middle + distance * along; }
};

/// None where the two have no part of the display in common.
[[nodiscard]] std::optional<OverlapLine> lineAcross(const ProjectorMapping& first, const ProjectorMapping& second,
                                                    const Display& display);

/// Luminance of white along a line, at evenly spaced points from its begin to its end.
struct Profile {
  struct Part {
    std::size_t projector = 0;
    std::vector<double> luminance;
  };
  std::vector<Part> parts;  // of the projectors that light any of it
  std::vector<double> sum;
};
[[nodiscard]] Profile profileAlong(const OverlapLine& line, const WallLight& light, Correction correction);

/// How unlike the whites of two projectors are over their overlap, each at full share and above its black.
struct OverlapDifference {
  double luminance = 0;  // root of the mean square, of the mean of the two
  double colour = 0;     // CIEDE2000 at equal brightness, of the means
};
[[nodiscard]] OverlapDifference differenceOver(const OverlapLine& line, std::size_t first, std::size_t second,
                                               const WallLight& light, Correction correction);

}  // namespace pixelflex::calib
