#include "calib/report/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/report/picture_uri.h"

namespace pixelflex::calib {
namespace {

struct Stop {
  double density;
  std::array<double, 3> colour;
};
/// Warm where text is soft, neutral at one to one, cool where there are pixels to spare.
constexpr std::array<Stop, 9> kStops = {{{0.50, {150, 45, 40}},
                                         {0.70, {200, 90, 60}},
                                         {0.85, {226, 150, 90}},
                                         {0.95, {240, 205, 150}},
                                         {1.00, {240, 232, 212}},
                                         {1.08, {190, 220, 222}},
                                         {1.25, {120, 180, 198}},
                                         {1.60, {60, 126, 160}},
                                         {2.00, {30, 78, 120}}}};

std::array<double, 3> colourAt(double density) {
  const double d = std::clamp(density, kStops.front().density, kStops.back().density);
  std::size_t i = 1;
  while (i + 1 < kStops.size() && d > kStops[i].density) ++i;
  const Stop& a = kStops[i - 1];
  const Stop& b = kStops[i];
  const double f = std::log(d / a.density) / std::log(b.density / a.density);
  std::array<double, 3> mixed{};
  for (std::size_t c = 0; c < 3; ++c) mixed[c] = a.colour[c] + f * (b.colour[c] - a.colour[c]);
  return mixed;
}

/// Where a density stands on the legend, 0 to 1.
double legendPlace(double density) {
  return std::log(density / kStops.front().density) / std::log(kStops.back().density / kStops.front().density);
}

}  // namespace

HeatMap::HeatMap(glm::dvec2 low, glm::dvec2 high, int columns, const Density& density)
    : low_(low),
      high_(high),
      columns_(columns),
      rows_(std::clamp(static_cast<int>(std::lround(columns * (high.y - low.y) / (high.x - low.x))), 2, 4 * columns)) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const auto value = density(middle(column, row));
      values_.push_back(value);
      if (!value) continue;
      least_ = std::min(least_, *value);
      most_ = std::max(most_, *value);
    }
  }
}

glm::dvec2 HeatMap::middle(int column, int row) const {
  return low_ + (high_ - low_) * glm::dvec2((column + 0.5) / columns_, (row + 0.5) / rows_);
}

std::string HeatMap::picture() const {
  devices::Image8 image({columns_, rows_}, 4);
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const auto value = at(column, row);
      if (!value) continue;
      const auto colour = colourAt(*value);
      for (int c = 0; c < 3; ++c) {
        image.at(column, row, c) = static_cast<std::uint8_t>(std::lround(colour[static_cast<std::size_t>(c)]));
      }
      image.at(column, row, 3) = 255;
    }
  }
  return pictureUri(image);
}

std::string HeatMap::svg(double line) const {
  const glm::dvec2 size = high_ - low_;
  std::string text = fmt::format(
      "<image x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" preserveAspectRatio=\"none\" "
      "href=\"{}\"/>\n",
      low_.x, low_.y, size.x, size.y, picture());
  text += fmt::format("<path class=\"iso\" d=\"{}\" stroke-width=\"{:.2f}\"/>\n", isoLine(1), line);
  text += fmt::format("<path class=\"iso\" d=\"{}\" stroke-width=\"{:.2f}\" stroke-dasharray=\"{:.1f} {:.1f}\"/>\n",
                      isoLine(1.25), line, 4 * line, 2 * line);
  return text;
}

std::string HeatMap::isoLine(double level) const {
  std::string path;
  for (int row = 0; row + 1 < rows_; ++row) {
    for (int column = 0; column + 1 < columns_; ++column) addCell(column, row, level, path);
  }
  return path;
}

/// Marching squares: the line enters and leaves a cell where an edge's ends lie on both sides of the level.
void HeatMap::addCell(int column, int row, double level, std::string& path) const {
  constexpr std::array<glm::ivec2, 4> kCorners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  std::vector<glm::dvec2> crossings;
  for (std::size_t edge = 0; edge < 4; ++edge) {
    const glm::ivec2 from = glm::ivec2(column, row) + kCorners[edge];
    const glm::ivec2 to = glm::ivec2(column, row) + kCorners[(edge + 1) % 4];
    const auto a = at(from.x, from.y);
    const auto b = at(to.x, to.y);
    if (!a || !b) return;
    if ((*a < level) == (*b < level)) continue;
    const double f = (level - *a) / (*b - *a);
    crossings.push_back(middle(from.x, from.y) * (1 - f) + middle(to.x, to.y) * f);
  }
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", crossings[i].x, crossings[i].y, crossings[i + 1].x,
                        crossings[i + 1].y);
  }
}

std::string heatLegend() {
  std::string text =
      "<svg class=\"legend\" viewBox=\"0 0 420 46\" role=\"img\" aria-label=\"Colours from half a projector pixel per "
      "desktop pixel, brown, over one, pale, to two, blue\"><defs><linearGradient id=\"heat\">";
  for (const auto& stop : kStops) {
    text += fmt::format("<stop offset=\"{:.3f}\" stop-color=\"rgb({:.0f},{:.0f},{:.0f})\"/>", legendPlace(stop.density),
                        stop.colour[0], stop.colour[1], stop.colour[2]);
  }
  text += "</linearGradient></defs><rect x=\"10\" y=\"4\" width=\"400\" height=\"16\" fill=\"url(#heat)\"/>";
  for (const double tick : {0.5, 0.7, 0.85, 1.0, 1.25, 1.6, 2.0}) {
    const double x = 10 + 400 * legendPlace(tick);
    const bool line = tick == 1.0 || tick == 1.25;
    text += fmt::format("<path class=\"iso\" d=\"M{0:.1f} {1}V24\" stroke-width=\"{2}\"{3}/>", x, line ? 4 : 20,
                        line ? 1.5 : 1, tick == 1.25 ? " stroke-dasharray=\"4 2\"" : "");
    text += fmt::format("<text x=\"{:.1f}\" y=\"39\" text-anchor=\"middle\" font-size=\"13\">{}</text>", x, tick);
  }
  return text + "</svg>\n";
}

}  // namespace pixelflex::calib
