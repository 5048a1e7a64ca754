#include "calib/report/report.h"

#include <fmt/format.h>

#include "calib/report/report_drawing.h"
#include "devices/image/image_error.h"
#include "devices/image/png_file.h"

namespace pixelflex::calib {
namespace {

constexpr const char* kHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Calibration of the wall</title>
<style>
:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 70rem; margin: 2rem auto; padding: 0 1rem; }
svg.wall { width: 100%; height: auto; } svg.wall text { fill: currentColor; }
table { border-collapse: collapse; } td, th { padding: .2rem .8rem; text-align: right; }
th { border-bottom: 1px solid; } td:first-child, th:first-child, td:last-child, th:last-child { text-align: left; }
.projectors { display: grid; grid-template-columns: repeat(auto-fill, minmax(20rem, 1fr)); gap: 1rem; }
svg.residuals, svg.mask { width: 100%; height: auto; display: block; margin-bottom: .3rem; }
svg.residuals rect { fill: #8882; } svg.residuals circle { fill: #888; }
svg.residuals line { stroke: #d33; stroke-width: 3; }
.note { color: #c60; }
</style></head><body>
)";

std::string figures(const Wall& wall, const Summary& summary) {
  std::string table = fmt::format(
      "<table><tr><th>projector</th><th>blobs</th><th>rms px</th><th>95 % px</th><th>max px</th><th>px/{}</th>"
      "<th>overlap</th><th>in display</th><th>note</th></tr>\n",
      escaped(wall.surface.units));
  for (const auto& p : summary.projectors) {
    if (!p.calibrated) {
      table += fmt::format("<tr><td>{}</td><td colspan=\"7\"></td><td class=\"note\">{}</td></tr>\n", escaped(p.name),
                           escaped(p.note));
      continue;
    }
    std::string neighbours;
    for (const auto& name : p.neighbours) neighbours += (neighbours.empty() ? "overlaps " : ", ") + name;
    table += fmt::format(
        "<tr><td>{}</td><td>{}/{}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.1f} %</td>"
        "<td>{:.1f} %</td><td>{}</td></tr>\n",
        escaped(p.name), p.quality.found, p.quality.shown, p.quality.rms, p.quality.p95, p.quality.maximum, p.density,
        p.overlapPercent, p.displayPercent,
        p.note.empty() ? escaped(neighbours) : "<span class=\"note\">" + escaped(p.note) + "</span>");
  }
  return table + "</table>\n";
}

std::string overview(const Wall& wall, const Calibration& calibration, const Summary& summary) {
  std::string text;
  const std::string units = escaped(wall.surface.units);
  if (const auto& d = calibration.display) {
    text += fmt::format("<p>Display {:.0f} × {:.0f} {} (dashed), desktop <b>{}×{}</b> pixels.", d->right - d->left,
                        d->bottom - d->top, units, d->resolution.width, d->resolution.height);
    if (summary.lit.islands.size() > 1) {
      text += fmt::format(" The lit area falls into {} parts.", summary.lit.islands.size());
    }
    if (!summary.lit.holes.empty()) text += fmt::format(" It has {} holes.", summary.lit.holes.size());
    text += "</p>\n";
  }
  if (const auto& camera = calibration.camera) {
    text += fmt::format(
        "<p>Camera {}×{}, {} checkerboard photographs, reprojection {:.3f} px rms; f = {:.1f}, {:.1f}; k = {:.4f}, "
        "{:.4f}, "
        "{:.4f}.</p>\n",
        camera->size.width, camera->size.height, camera->photos, camera->rmsPx, camera->fx, camera->fy,
        camera->radial[0], camera->radial[1], camera->radial[2]);
  }
  if (const auto& surface = calibration.surface) {
    text += fmt::format("<p>Fiducials fit the wall to {:.3f} {} rms.</p>\n", surface->rms, units);
  }
  return text;
}

std::string maskOf(const std::filesystem::path& folder, const ProjectorCalibration& projector) {
  if (!projector.alpha) return "";
  try {
    return drawMask(devices::readPng16(folder / *projector.alpha));
  } catch (const devices::ImageError&) {
    return "";  // a report on what is there; `pixelflex check` names what is not
  }
}

}  // namespace

std::string reportHtml(const std::filesystem::path& folder, const Wall& wall, const Calibration& calibration,
                       const Summary& summary) {
  std::string html = kHead;
  html += "<h1>Calibration of the wall</h1>\n" + drawWall(calibration, summary);
  html += overview(wall, calibration, summary);
  html += "<h2>Projectors</h2>\n" + figures(wall, summary);
  html += "<p>Errors are what the lens model leaves of each measured blob, in projector pixels.</p>\n";
  html += "<h2>Residuals (a thousand times enlarged) and blend masks</h2>\n<div class=\"projectors\">\n";
  for (const auto& projector : calibration.projectors) {
    html += fmt::format("<figure><figcaption>{}</figcaption>\n", escaped(projector.name));
    html += drawResiduals(projector) + maskOf(folder, projector) + "</figure>\n";
  }
  return html + "</div></body></html>\n";
}

}  // namespace pixelflex::calib
