#include "calib/report/projector_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "calib/geometry/projector_mapping.h"
#include "calib/procedure/summary.h"
#include "calib/report/heat_map.h"
#include "calib/report/html_text.h"
#include "calib/report/picture_uri.h"

namespace pixelflex::calib {
namespace {

struct Arrow {
  glm::dvec2 at{0, 0};
  glm::dvec2 error{0, 0};
};

std::vector<Arrow> arrowsOf(const ProjectorCalibration& projector) {
  constexpr std::size_t kMost = 400;  // more are a thicket
  const std::size_t stride = (projector.samples.size() + kMost - 1) / kMost;
  const ProjectorMapping mapping(projector.model, projector.resolution);
  std::vector<Arrow> arrows;
  for (std::size_t i = 0; i < projector.samples.size(); i += stride) {
    const auto& sample = projector.samples[i];
    const auto modelled = mapping.projectorFromWall(sample.pointInWall);
    if (modelled) arrows.push_back({sample.pointInProjector, *modelled - sample.pointInProjector});
  }
  return arrows;
}

/// So that the arrow which five of a hundred exceed spans most of the way to the next; 0 when there is nothing to see.
double magnificationFor(const std::vector<Arrow>& arrows, devices::Size resolution) {
  std::vector<double> lengths;
  for (const auto& arrow : arrows) lengths.push_back(glm::length(arrow.error));
  std::ranges::sort(lengths);
  const double long95 = lengths.empty() ? 0 : lengths[static_cast<std::size_t>(0.95 * double(lengths.size() - 1))];
  if (long95 < 1e-6) return 0;
  const double spacing = std::sqrt(static_cast<double>(resolution.area()) / static_cast<double>(arrows.size()));
  return roundedDown(0.9 * spacing / long95);
}

std::string drawArrows(const std::vector<Arrow>& arrows, double magnification, double line) {
  std::string shafts, feet;
  for (const auto& [at, error] : arrows) {
    const glm::dvec2 shaft = error * magnification;
    feet += fmt::format("M{:.1f} {:.1f}h0", at.x, at.y);
    const double length = glm::length(shaft);
    if (length < line) continue;
    const glm::dvec2 along = shaft / length * std::min(4 * line, 0.6 * length);
    const glm::dvec2 side(-along.y / 2, along.x / 2);
    shafts += fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}m{:.1f} {:.1f}l{:.1f} {:.1f}l{:.1f} {:.1f}", at.x, at.y, shaft.x,
                          shaft.y, side.x - along.x, side.y - along.y, along.x - side.x, along.y - side.y,
                          -along.x - side.x, -along.y - side.y);
  }
  return fmt::format(
      "<path class=\"foot\" d=\"{}\" stroke-width=\"{:.2f}\"/><path class=\"arrow\" d=\"{}\" "
      "stroke-width=\"{:.2f}\"/>\n",
      feet, 2.2 * line, shafts, line);
}

std::string drawRule(devices::Size resolution, double magnification, double unit) {
  const double error = roundedDown(0.2 * resolution.width / magnification);
  const double y = resolution.height + 10 * unit;
  return fmt::format(
      "<path class=\"arrow\" d=\"M0 {0:.1f}v{1:.1f}M0 {2:.1f}h{3:.1f}M{3:.1f} {0:.1f}v{1:.1f}\" "
      "stroke-width=\"{4:.2f}\"/><text x=\"{5:.1f}\" y=\"{6:.1f}\" font-size=\"{7:.2f}\">{8} px, enlarged {9} "
      "times</text>\n",
      y - unit, 2 * unit, y, error * magnification, unit / 2, error * magnification + 2 * unit, y + 1.5 * unit,
      3.8 * unit, plain(error), plain(magnification));
}

/// With room around the frame, so that what points out of it is not cut off.
std::string openFrame(devices::Size resolution, double around, double below, const std::string& label) {
  return fmt::format(
      "<svg class=\"frame\" viewBox=\"{0:.1f} {0:.1f} {1:.1f} {2:.1f}\" role=\"img\" aria-label=\"{5}\"><rect "
      "class=\"paper\" width=\"{3}\" height=\"{4}\"/>\n",
      -around, resolution.width + 2 * around, resolution.height + around + below, resolution.width, resolution.height,
      escaped(label));
}

}  // namespace

std::string drawResiduals(const ProjectorCalibration& projector) {
  const auto arrows = arrowsOf(projector);
  const double magnification = magnificationFor(arrows, projector.resolution);
  const double unit = projector.resolution.width / 100.0;
  std::string svg = openFrame(projector.resolution, 6 * unit, 13 * unit, "Residuals of " + projector.name);
  if (magnification <= 0) {
    return svg + fmt::format("<text x=\"0\" y=\"{:.1f}\" font-size=\"{:.2f}\">exact: nothing is left</text></svg>\n",
                             projector.resolution.height + 8 * unit, 3.8 * unit);
  }
  svg += drawArrows(arrows, magnification, unit / (arrows.size() > 150 ? 4 : 2.5));
  return svg + drawRule(projector.resolution, magnification, unit) + "</svg>\n";
}

DensityDrawing drawDensity(const ProjectorCalibration& projector, const Display& display) {
  const ProjectorMapping mapping(projector);
  const double perUnit = desktopPixelsPerUnit(display);
  const glm::dvec2 size(projector.resolution.width, projector.resolution.height);
  const HeatMap map({0, 0}, size, 48, [&](glm::dvec2 point) -> std::optional<double> {
    const double density = mapping.density(point);
    return density > 0 ? std::optional(density / perUnit) : std::nullopt;
  });
  if (map.empty()) return {};
  const double unit = size.x / 100;
  const std::string open = openFrame(projector.resolution, 0, 0, "Density of " + projector.name);
  return {open + map.svg(unit / 2) + "</svg>\n", map.least(), map.most()};
}

std::string drawMask(const devices::Image16& mask) {
  constexpr int kColumns = 128;
  const int rows = std::max(1, kColumns * mask.height() / mask.width());
  devices::Image8 small({kColumns, rows}, 1);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const int x = (2 * column + 1) * mask.width() / (2 * kColumns);
      const int y = (2 * row + 1) * mask.height() / (2 * rows);
      small.at(column, row) = static_cast<std::uint8_t>(mask.at(x, y) * 255 / 65535);
    }
  }
  return fmt::format("<img class=\"frame\" src=\"{}\" width=\"{}\" height=\"{}\" alt=\"Blend mask\"/>\n",
                     pictureUri(small), kColumns, rows);
}

}  // namespace pixelflex::calib
