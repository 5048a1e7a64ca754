#include "calib/capture/exposure_name.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

namespace pixelflex::calib {
namespace {

std::optional<double> positive(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && std::isfinite(value) && value > 0 ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string nameWithExposure(const std::string& pattern, double seconds) {
  std::ostringstream text;
  text.precision(6);
  text << pattern << '@' << seconds;
  return text.str();
}

std::string patternOfName(const std::string& name) {
  return name.substr(0, name.find('@'));
}

std::optional<double> exposureOfName(const std::string& name) {
  const std::size_t at = name.find('@');
  if (at == std::string::npos) return std::nullopt;
  const std::string_view text = std::string_view(name).substr(at + 1);
  const std::size_t stroke = text.find('_');
  if (stroke == std::string_view::npos) return positive(text);
  const auto above = positive(text.substr(0, stroke));
  const auto below = positive(text.substr(stroke + 1));
  return above && below ? std::optional(*above / *below) : std::nullopt;
}

}  // namespace pixelflex::calib
