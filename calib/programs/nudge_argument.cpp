#include "calib/programs/nudge_argument.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>

namespace pixelflex::calib {
namespace {

std::optional<double> numberOf(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<glm::dvec2> pairOf(std::string_view text) {
  const auto slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto x = numberOf(text.substr(0, slash));
  const auto y = numberOf(text.substr(slash + 1));
  if (!x || !y) return std::nullopt;
  return glm::dvec2(*x, *y);
}

bool apply(Nudge& nudge, std::string_view key, std::string_view value) {
  constexpr std::array<std::string_view, 4> kCorners = {"tl", "tr", "br", "bl"};
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    if (key != kCorners[i]) continue;
    const auto offset = pairOf(value);
    if (offset) nudge.corners[i] = *offset;
    return offset.has_value();
  }
  const auto number = numberOf(value);
  if (!number) return false;
  if (key == "x") nudge.shift.x = *number;
  if (key == "y") nudge.shift.y = *number;
  if (key == "roll") nudge.roll = *number;
  return key == "x" || key == "y" || key == "roll";
}

}  // namespace

std::pair<std::string, Nudge> parseNudgeArgument(std::string_view text) {
  const auto refuse = [text] {
    return std::invalid_argument("--nudge " + std::string(text) +
                                 ": write NAME:x=1.5,y=-0.5,roll=0.1,tl=2/-1 with any of "
                                 "x, y, roll, tl, tr, br, bl");
  };
  const auto colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0) throw refuse();
  std::pair<std::string, Nudge> result{std::string(text.substr(0, colon)), {}};
  std::string_view rest = text.substr(colon + 1);
  while (!rest.empty()) {
    const auto comma = rest.find(',');
    const auto part = rest.substr(0, comma);
    const auto equals = part.find('=');
    if (equals == std::string_view::npos) throw refuse();
    if (!apply(result.second, part.substr(0, equals), part.substr(equals + 1))) throw refuse();
    rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
  }
  return result;
}

}  // namespace pixelflex::calib
