#include "calib/report/report_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/geometry/projector_mapping.h"

namespace pixelflex::calib {
namespace {

struct Frame {
  glm::dvec2 low{1e300};
  glm::dvec2 high{-1e300};
  void include(glm::dvec2 point) {
    low = {std::min(low.x, point.x), std::min(low.y, point.y)};
    high = {std::max(high.x, point.x), std::max(high.y, point.y)};
  }
};

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

}  // namespace

std::string escaped(const std::string& text) {
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
      default:
        safe += c;
    }
  }
  return safe;
}

std::string colourOf(std::size_t projector) {
  // Steps of the golden angle keep the hues of any number of projectors apart.
  return fmt::format("hsl({:.0f} 65% 45%)", std::fmod(static_cast<double>(projector) * 137.508, 360.0));
}

std::string drawWall(const Calibration& calibration, const Summary& summary) {
  Frame frame;
  for (const auto& projector : summary.projectors) {
    for (const auto& point : projector.outline) frame.include(point);
  }
  if (frame.low.x > frame.high.x) return "";
  const glm::dvec2 extent = frame.high - frame.low;
  const double margin = 0.04 * std::max(extent.x, extent.y);
  const double line = margin / 12;
  std::string svg = fmt::format(
      "<svg class=\"wall\" viewBox=\"{:.1f} {:.1f} {:.1f} {:.1f}\" role=\"img\" aria-label=\"The wall from the "
      "audience\">\n",
      frame.low.x - margin, frame.low.y - margin, extent.x + 2 * margin, extent.y + 2 * margin);
  for (std::size_t i = 0; i < summary.projectors.size(); ++i) {
    const auto& projector = summary.projectors[i];
    if (!projector.calibrated) continue;
    const glm::dvec2 centre = centreOf(projector.outline);
    svg += fmt::format(
        "<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"0.25\" stroke=\"{}\" stroke-width=\"{:.1f}\"/>\n"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
        points(projector.outline), colourOf(i), colourOf(i), line, centre.x, centre.y, margin, escaped(projector.name));
  }
  if (const auto& d = calibration.display) {
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"currentColor\" "
        "stroke-width=\"{:.1f}\" stroke-dasharray=\"{:.1f}\"/>\n",
        d->left, d->top, d->right - d->left, d->bottom - d->top, 2 * line, 4 * line);
  }
  return svg + "</svg>\n";
}

std::string drawResiduals(const ProjectorCalibration& projector) {
  constexpr double kMagnification = 1000;
  const ProjectorMapping mapping(projector.model, projector.resolution);
  std::string svg =
      fmt::format("<svg class=\"residuals\" viewBox=\"0 0 {} {}\"><rect width=\"100%\" height=\"100%\"/>\n",
                  projector.resolution.width, projector.resolution.height);
  for (const auto& sample : projector.samples) {
    const auto fitted = mapping.projectorFromWall(sample.pointInWall);
    if (!fitted) continue;
    const glm::dvec2 at = sample.pointInProjector;
    const glm::dvec2 tip = at + (*fitted - at) * kMagnification;
    svg += fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"5\"/><line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" "
        "y2=\"{3:.1f}\"/>\n",
        at.x, at.y, tip.x, tip.y);
  }
  return svg + "</svg>\n";
}

std::string drawMask(const devices::Image16& mask) {
  constexpr int kColumns = 64;
  const int rows = std::max(1, kColumns * mask.height() / mask.width());
  std::string svg =
      fmt::format("<svg class=\"mask\" viewBox=\"0 0 {} {}\" shape-rendering=\"crispEdges\">\n", kColumns, rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const int x = (2 * column + 1) * mask.width() / (2 * kColumns);
      const int y = (2 * row + 1) * mask.height() / (2 * rows);
      const int grey = mask.at(x, y) * 255 / 65535;
      svg += fmt::format("<path d=\"M{} {}h1v1h-1z\" fill=\"#{:02x}{:02x}{:02x}\"/>", column, row, grey, grey, grey);
    }
  }
  return svg + "</svg>\n";
}

}  // namespace pixelflex::calib
