#pragma once

#include <array>
#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <string>
#include <string_view>

namespace pixelflex::calib {

/// A correction that a person laid over what was measured: the projector's picture moved within its frame. All in
/// projector pixels and degrees; applied in this order: corners, roll about the frame's middle, shift.
struct Nudge {
  glm::dvec2 shift{0, 0};
  double roll = 0;                      // degrees, clockwise on the frame
  std::array<glm::dvec2, 4> corners{};  // top left, top right, bottom right, bottom left: how far each moves
  bool operator==(const Nudge&) const = default;
};

using Nudges = std::map<std::string, Nudge>;  // by projector

inline constexpr int kNudgeVersion = 1;

/// WALL/nudge.yaml, a layer of its own that no calibration touches. No file: no nudges. Throws StoreError.
[[nodiscard]] Nudges loadNudges(const std::filesystem::path& folder);
[[nodiscard]] Nudges parseNudges(std::string_view text, const std::string& file);
[[nodiscard]] std::string formatNudges(const Nudges& nudges);
/// Atomic; removes the file when there are none.
void saveNudges(const std::filesystem::path& folder, const Nudges& nudges);

}  // namespace pixelflex::calib
