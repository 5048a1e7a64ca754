#include "calib/report/html_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pixelflex::calib {

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string colourOf(std::size_t projector) {
  // Steps of the golden angle keep the hues of any number of projectors apart.
  return fmt::format("hsl({:.0f} 62% 48%)", std::fmod(205 + static_cast<double>(projector) * 137.508, 360.0));
}

std::string colourOf(const Summary& summary, const std::string& name) {
  const auto found = std::ranges::find(summary.projectors, name, &ProjectorSummary::name);
  if (found == summary.projectors.end()) return "#888";
  return colourOf(static_cast<std::size_t>(found - summary.projectors.begin()));
}

double roundedDown(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  const double digit = value / power;
  return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

std::string plain(double value) {
  return fmt::format("{:.6g}", value);
}

std::string chip(const std::string& colour) {
  return fmt::format("<span class=\"chip\" style=\"background:{}\"></span>", colour);
}

std::string fact(const std::string& term, const std::string& figure, const std::string& note) {
  return fmt::format("<div><dt>{}</dt><dd>{}<small>{}</small></dd></div>\n", term, figure, note);
}

std::string openTable(const std::string& label, const std::vector<std::string>& heads) {
  std::string html = fmt::format(
      "<div class=\"scroll sheet\" role=\"region\" aria-label=\"{0}\" tabindex=\"0\"><table><thead><tr>", label);
  for (const auto& head : heads) html += "<th scope=\"col\">" + head + "</th>";
  return html + "</tr></thead>\n<tbody>\n";
}

std::string unitsOf(const Wall& wall) {
  return wall.isFlat() ? "px" : wall.surface.wallUnits();
}

}  // namespace pixelflex::calib
