#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/store/wall.h"
#include "calib/store/yaml_reader.h"

namespace pixelflex::calib {

/// What the values in the store's files may be; shared by wall.yaml and calibration.yaml.
inline constexpr int kMinResolution = 16;
inline constexpr int kMaxResolution = 16384;
inline constexpr int kMaxExtent = 32768;                                // of a desktop, pixels
inline constexpr std::int64_t kMaxDesktopArea = std::int64_t{1} << 29;  // pixels: 2 GiB at four bytes
inline constexpr std::size_t kMaxProjectors = 64;
inline constexpr std::size_t kMaxFiducials = 256;
inline constexpr int kMaxArucoId = 49;  // DICT_4X4_50
inline constexpr double kMaxCoordinate = 1e9;
inline constexpr std::size_t kMaxName = 64;
inline constexpr std::size_t kMaxPath = 4096;

/// A text of one to `longest` bytes.
[[nodiscard]] std::string readText(const YamlReader::Node& node, std::size_t longest);
/// A projector's name: letters, digits, '_', '-' and '.', not first; it becomes part of file names.
[[nodiscard]] std::string readName(const YamlReader::Node& node);
[[nodiscard]] glm::dvec2 readPoint(const YamlReader::Node& node);
[[nodiscard]] glm::ivec2 readPixel(const YamlReader::Node& node, int minimum, int maximum);
[[nodiscard]] devices::Size readSize(const YamlReader::Node& node, int minimum, int maximum);
/// `{at: [x, y]}` of a screen that shows the desktop one to one; the screen must end within kMaxExtent.
[[nodiscard]] std::optional<glm::ivec2> readFlat(const YamlReader::Node& node, devices::Size resolution);

/// Notes every name in a list of projectors that an earlier one has.
void checkUniqueNames(const YamlReader::Node& projectors);

/// "16:9"; none unless both are positive numbers.
[[nodiscard]] std::optional<AspectRatio> parseAspect(std::string_view text);

/// True when no four of the points determine a plane collineation: all of them, or all but one, on one line (within a
/// thousandth of their extent).
[[nodiscard]] bool leavesCollineationOpen(const std::vector<Fiducial>& fiducials);

}  // namespace pixelflex::calib
