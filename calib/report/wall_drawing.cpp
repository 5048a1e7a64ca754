#include "calib/report/wall_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "calib/geometry/projector_mapping.h"
#include "calib/report/heat_map.h"
#include "calib/report/html_text.h"

namespace pixelflex::calib {
namespace {

/// Where the wall is what the camera sees, fiducials have no place on it.
std::vector<Fiducial> shownFiducials(const Wall& wall) {
  return wall.surface.shape == SurfaceShape::kCamera ? std::vector<Fiducial>{} : wall.surface.fiducials;
}

struct Frame {
  glm::dvec2 low{1e300};
  glm::dvec2 high{-1e300};
  void include(glm::dvec2 point) { low = glm::min(low, point), high = glm::max(high, point); }
  [[nodiscard]] bool empty() const { return low.x > high.x; }
};

Frame frameOf(const Summary& summary) {
  Frame frame;
  for (const auto& projector : summary.projectors) {
    for (const auto& point : projector.outline) frame.include(point);
  }
  return frame;
}

std::string points(const Outline& outline) {
  std::string text;
  for (const auto& point : outline) text += fmt::format("{:.1f},{:.1f} ", point.x, point.y);
  return text;
}

glm::dvec2 centreOf(const Outline& outline) {
  glm::dvec2 sum{0, 0};
  for (const auto& point : outline) sum += point;
  return sum / static_cast<double>(outline.size());
}

class WallDrawing {
 public:
  WallDrawing(const Wall& wall, const Calibration& calibration, const Summary& summary)
      : wall_(wall), calibration_(calibration), summary_(summary), frame_(frameOf(summary)) {
    for (const auto& fiducial : shownFiducials(wall)) {
      if (!wall.isFlat()) frame_.include(fiducial.pointInWall);
    }
    const glm::dvec2 extent = frame_.high - frame_.low;
    unit_ = std::max(extent.x, 1.6 * extent.y) / 100;
  }

  [[nodiscard]] std::string draw() {
    const glm::dvec2 low = frame_.low - glm::dvec2(3 * unit_, 5 * unit_);
    const glm::dvec2 size = frame_.high - frame_.low + glm::dvec2(6 * unit_, 10 * unit_);
    svg_ = fmt::format(
        "<svg class=\"wall\" viewBox=\"{:.1f} {:.1f} {:.1f} {:.1f}\" role=\"img\" aria-label=\"The wall from the "
        "audience: {} projectors' footprints and the display\">\n",
        low.x, low.y, size.x, size.y, summary_.projectors.size());
    for (std::size_t i = 0; i < summary_.projectors.size(); ++i) drawFootprint(i);
    for (const auto& hole : summary_.lit.holes) {
      svg_ += fmt::format("<polygon points=\"{}\" fill=\"url(#hatch)\" class=\"hole\" stroke-width=\"{:.2f}\"/>\n",
                          points(hole), unit_ / 5);
    }
    drawDisplay();
    if (!wall_.isFlat()) drawFiducials();
    for (std::size_t i = 0; i < summary_.projectors.size(); ++i) drawName(i);
    drawScale();
    return svg_ + "</svg>\n";
  }

 private:
  void drawFootprint(std::size_t i) {
    const auto& projector = summary_.projectors[i];
    if (!projector.calibrated) return;
    svg_ += fmt::format(
        "<polygon points=\"{0}\" fill=\"{1}\" fill-opacity=\"0.2\" stroke=\"{1}\" stroke-width=\"{2:.2f}\" "
        "stroke-linejoin=\"round\"><title>{3}</title></polygon>\n",
        points(projector.outline), colourOf(i), unit_ / 4, escaped(projector.name));
  }

  /// Two projectors on the same place have their names one below the other.
  void drawName(std::size_t i) {
    const auto& projector = summary_.projectors[i];
    if (!projector.calibrated) return;
    const double size = std::min(3.0 * unit_, std::sqrt(areaOf(projector.outline)) / 5);
    glm::dvec2 at = centreOf(projector.outline) + glm::dvec2(0, size / 3);
    const auto taken = [&](glm::dvec2 other) {
      return std::abs(other.x - at.x) < 3 * size && std::abs(other.y - at.y) < 1.1 * size;
    };
    while (std::ranges::any_of(names_, taken)) at.y += 0.6 * size;
    names_.push_back(at);
    svg_ += fmt::format(
        "<text class=\"name\" x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.2f}\" stroke-width=\"{:.2f}\" "
        "text-anchor=\"middle\">{}</text>\n",
        at.x, at.y, size, size / 5, escaped(projector.name));
  }

  void drawDisplay() {
    if (!calibration_.display) return;
    const Display& d = *calibration_.display;
    svg_ += fmt::format(
        "<rect class=\"display\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" stroke-width=\"{:.2f}\" "
        "stroke-dasharray=\"{:.1f} {:.1f}\"/>\n",
        d.left, d.top, d.right - d.left, d.bottom - d.top, unit_ / 2.5, 1.6 * unit_, 0.8 * unit_);
    svg_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.2f}\">desktop {} × {}</text>\n", frame_.low.x,
                        frame_.low.y - 1.6 * unit_, 2 * unit_, d.resolution.width, d.resolution.height);
  }

  void drawFiducials() {
    for (const auto& fiducial : shownFiducials(wall_)) {
      const glm::dvec2 at = fiducial.pointInWall;
      svg_ += fmt::format(
          "<path class=\"fiducial\" d=\"M{0:.1f} {1:.1f}h{2:.1f}M{3:.1f} {4:.1f}v{2:.1f}\" stroke-width=\"{5:.2f}\">"
          "<title>fiducial{6} at {3:.0f}, {1:.0f}</title></path>\n",
          at.x - unit_, at.y, 2 * unit_, at.x, at.y - unit_, unit_ / 4,
          fiducial.aruco ? " " + std::to_string(*fiducial.aruco) : "");
    }
  }

  void drawScale() {
    const double length = roundedDown(25 * unit_);
    const double x = frame_.low.x;
    const double y = frame_.high.y + 2.5 * unit_;
    svg_ += fmt::format(
        "<path class=\"rule\" d=\"M{0:.1f} {1:.1f}v{2:.1f}M{0:.1f} {3:.1f}h{4:.1f}M{5:.1f} {1:.1f}v{2:.1f}\" "
        "stroke-width=\"{6:.2f}\"/><text x=\"{7:.1f}\" y=\"{8:.1f}\" font-size=\"{9:.2f}\">{10} {11}</text>\n",
        x, y - unit_ / 2, unit_, y, length, x + length, unit_ / 4, x + length + unit_, y + 0.7 * unit_, 2 * unit_,
        plain(length), escaped(unitsOf(wall_)));
  }

  const Wall& wall_;
  const Calibration& calibration_;
  const Summary& summary_;
  Frame frame_;
  double unit_ = 1;  // a hundredth of the drawing's width
  std::vector<glm::dvec2> names_;
  std::string svg_;
};

/// Pixels per wall unit as the blend mixes them: each projector by its density to the power of equation 7.
std::optional<double> densityAt(glm::dvec2 pointInWall, const std::vector<ProjectorMapping>& mappings,
                                double exponent) {
  double weights = 0, sum = 0;
  for (const auto& mapping : mappings) {
    const auto p = mapping.projectorFromWall(pointInWall);
    if (!p || !mapping.insideFrame(*p)) continue;
    const double density = mapping.density(*p);
    const double weight = std::pow(density, exponent);
    weights += weight, sum += weight * density;
  }
  return weights > 0 ? std::optional(sum / weights) : std::nullopt;
}

}  // namespace

std::string drawWall(const Wall& wall, const Calibration& calibration, const Summary& summary) {
  if (frameOf(summary).empty()) return "";
  return WallDrawing(wall, calibration, summary).draw();
}

std::string drawWallDensity(const Wall& wall, const Calibration& calibration, const Summary& summary) {
  if (!calibration.display || summary.lit.area <= 0) return "";
  const Display& d = *calibration.display;
  std::vector<ProjectorMapping> mappings;
  for (const auto& projector : calibration.projectors) mappings.emplace_back(projector);
  const double perUnit = desktopPixelsPerUnit(d);
  const HeatMap map({d.left, d.top}, {d.right, d.bottom}, 160, [&](glm::dvec2 point) -> std::optional<double> {
    const auto density = densityAt(point, mappings, wall.blend.densityExponent);
    return density ? std::optional(*density / perUnit) : std::nullopt;
  });
  if (map.empty()) return "";
  const double unit = (d.right - d.left) / 100;
  std::string svg = fmt::format(
      "<svg class=\"wall\" viewBox=\"{:.1f} {:.1f} {:.1f} {:.1f}\" role=\"img\" aria-label=\"Projector pixels per "
      "desktop pixel over the display, {:.2f} to {:.2f}\">\n",
      d.left, d.top, d.right - d.left, d.bottom - d.top, map.least(), map.most());
  svg += map.svg(unit / 5);
  for (const auto& projector : summary.projectors) {
    svg += fmt::format("<polygon class=\"outline\" points=\"{}\" stroke-width=\"{:.2f}\"/>\n",
                       points(projector.outline), unit / 10);
  }
  return svg + "</svg>\n" + heatLegend();
}

}  // namespace pixelflex::calib
