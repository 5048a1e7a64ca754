#include "devices/control/setting.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace pixelflex::devices {
namespace {

std::string numberText(double number) {
  std::array<char, 32> buffer{};
  // Angles come from counts: their digits beyond the fourth say nothing.
  const double rounded = std::round(number * 1e4) / 1e4;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), rounded + 0.0);
  return {buffer.data(), end};
}

std::optional<double> numberOf(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace

std::string textOf(const SettingValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return numberText(*number);
  return std::get<std::string>(value);
}

std::string rangeText(const SettingInfo& info) {
  if (!info.words) {
    const std::string unit = info.unit.empty() ? "" : " " + info.unit;
    return "from " + numberText(info.minimum) + " to " + numberText(info.maximum) + unit;
  }
  std::string list;
  for (std::size_t i = 0; i < info.choices.size(); ++i) {
    list += (i == 0 ? "" : i + 1 == info.choices.size() ? " or " : ", ") + info.choices[i];
  }
  return list;
}

SettingValue parseSetting(const SettingInfo& info, std::string_view text) {
  const std::string quoted = info.name + "=" + std::string(text.substr(0, 80));
  if (info.words) {
    if (std::ranges::find(info.choices, text) != info.choices.end()) return std::string(text);
    throw std::invalid_argument(quoted + ": it can be " + rangeText(info));
  }
  const auto number = numberOf(text);
  const double slack = 0.5 * info.step;  // the ends themselves are no round numbers in degrees
  if (!number || *number < info.minimum - slack || *number > info.maximum + slack) {
    throw std::invalid_argument(quoted + ": it can be a number " + rangeText(info));
  }
  return std::clamp(*number, info.minimum, info.maximum);
}

}  // namespace pixelflex::devices
