#include "calib/report/report_tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/report/html_text.h"

namespace pixelflex::calib {
namespace {

/// A figure that older calibrations do not hold is left blank.
std::string known(double value, int digits) {
  return value > 0 ? fmt::format("{:.{}f}", value, digits) : "–";
}

/// A cure's command, which stands at its end, set apart so that it is not broken across lines.
std::string withCommand(const std::string& cure) {
  const auto begin = cure.find("pixelflex ");
  if (begin == std::string::npos) return escaped(cure) + ".";
  return escaped(cure.substr(0, begin)) + "<code>" + escaped(cure.substr(begin)) + "</code>";
}

const char* wordOf(Severity severity) {
  return severity == Severity::kBad ? "bad" : "notice";
}

std::string seamVerdict(const std::string& where, const std::vector<Finding>& findings) {
  std::string words;
  for (const auto& finding : findings) {
    if (finding.where != where) continue;
    words += fmt::format("<span class=\"tag {0}\">{0}</span>{1} ", wordOf(finding.severity), escaped(finding.what));
  }
  return words.empty() ? "<span class=\"tag good\">good</span>" : words;
}

}  // namespace

std::string factsHtml(const Wall& wall, const Calibration& calibration, const Summary& summary) {
  std::string html = "<dl class=\"facts\">\n";
  const auto calibrated = std::ranges::count_if(summary.projectors, &ProjectorSummary::calibrated);
  html += fact("Projectors", fmt::format("{} of {}", calibrated, summary.projectors.size()), "calibrated");
  const std::string units = escaped(unitsOf(wall));
  if (const auto& d = calibration.display) {
    const double width = d->right - d->left;
    const double height = d->bottom - d->top;
    html += fact("Desktop", fmt::format("{} × {}", d->resolution.width, d->resolution.height), "pixels");
    html += fact("Display area", fmt::format("{:.0f} × {:.0f}", width, height),
                 units + (summary.lit.area > 0
                              ? fmt::format(", {:.0f} % of the lit area", 100 * width * height / summary.lit.area)
                              : ""));
  }
  if (const SeamFigures seams = seamFigures(summary.seams); seams.count > 0) {
    html += fact("Expected seam error", fmt::format("{:.2f} px", seams.rms),
                 fmt::format("rms of {}; at worst {:.2f} px", seams.count, seams.worst));
  }
  return html + "</dl>\n";
}

std::string findingsHtml(const std::vector<Finding>& findings) {
  if (findings.empty()) return "<p>Nothing to remark: every figure is within its bounds.</p>\n";
  std::string html = "<ul class=\"findings\">\n";
  for (const auto& finding : findings) {
    html += fmt::format(
        "<li class=\"{0}\"><p><span class=\"tag {0}\">{0}</span><strong>{1}</strong>: {2}.</p>"
        "<dl class=\"why\"><dt>Cause</dt><dd>{3}.</dd><dt>Cure</dt><dd>{4}</dd></dl></li>\n",
        wordOf(finding.severity), escaped(finding.where), escaped(finding.what), escaped(finding.cause),
        withCommand(finding.cure));
  }
  return html + "</ul>\n";
}

std::string projectorTable(const Wall& wall, const Summary& summary) {
  std::string html = openTable("Figures of the projectors",
                               {"projector", "points", "rms<br/>px", "95 %<br/>px", "max<br/>px", "held-out<br/>px",
                                "model ±<br/>px", "camera<br/>px/px", "density<br/>px/" + escaped(unitsOf(wall)),
                                "px per<br/>desktop px", "overlap<br/>%", "in display<br/>%"});
  for (std::size_t i = 0; i < summary.projectors.size(); ++i) {
    const auto& p = summary.projectors[i];
    html += "<tr><th scope=\"row\">" + chip(colourOf(i)) + escaped(p.name) + "</th>";
    if (!p.calibrated) {
      html += "<td colspan=\"11\" class=\"words\">" + escaped(p.note) + "</td></tr>\n";
      continue;
    }
    html += fmt::format(
        "<td>{}/{}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.3f}</td>"
        "<td>{}</td><td>{:.1f}</td><td>{:.1f}</td></tr>\n",
        p.quality.found, p.quality.shown, p.quality.rms, p.quality.p95, p.quality.maximum, known(p.quality.heldOut, 3),
        known(p.quality.deviation, 3), known(p.quality.cameraScale, 2), p.density, known(p.desktopDensity, 2),
        p.overlapPercent, p.displayPercent);
  }
  return html + kCloseTable;
}

std::string seamTable(const Summary& summary, const std::vector<Finding>& findings) {
  if (summary.seams.empty()) return "<p>No two projectors overlap.</p>\n";
  std::string html =
      openTable("Overlaps", {"projectors", "overlap<br/>%", "shared with<br/>others %", "narrowest<br/>desktop px",
                             "expected<br/>rms px", "expected<br/>worst px"});
  html.insert(html.rfind("</tr></thead>"), "<th scope=\"col\" class=\"words\">verdict</th>");
  for (const auto& seam : summary.seams) {
    html += fmt::format("<tr><th scope=\"row\">{}{} and {}{}</th><td>{:.1f}</td><td>{:.0f}</td>",
                        chip(colourOf(summary, seam.first)), escaped(seam.first), chip(colourOf(summary, seam.second)),
                        escaped(seam.second), seam.overlapPercent, seam.sharedPercent);
    if (!seam.insideDisplay) {
      html += "<td colspan=\"3\"></td><td class=\"words\">outside the display</td></tr>\n";
      continue;
    }
    html +=
        fmt::format("<td>{:.0f}</td><td>{:.3f}</td><td>{:.3f}</td><td class=\"words\">{}</td></tr>\n", seam.narrowest,
                    seam.expectedRms, seam.expectedWorst, seamVerdict(seam.first + " and " + seam.second, findings));
  }
  return html + kCloseTable;
}

std::string measurementTable(const Wall& wall, const Calibration& calibration) {
  std::string rows;
  const auto row = [&](const std::string& term, const std::string& text) {
    rows += "<tr><th scope=\"row\">" + term + "</th><td class=\"words\">" + text + "</td></tr>\n";
  };
  if (const auto& c = calibration.camera) {
    row("Camera", fmt::format("{} × {} pixels, f {:.1f} / {:.1f}, centre {:.1f} / {:.1f}", c->size.width,
                              c->size.height, c->fx, c->fy, c->cx, c->cy));
    row("Lens", fmt::format("radial {:.4f}, {:.4f}, {:.4f}; tangential {:.5f}, {:.5f}", c->radial[0], c->radial[1],
                            c->radial[2], c->tangential[0], c->tangential[1]));
    row("Checkerboard", c->photos > 0
                            ? fmt::format("{} photographs, reproduced to {:.3f} camera pixels rms", c->photos, c->rmsPx)
                            : "none: known intrinsics");
  }
  if (wall.surface.shape == SurfaceShape::kCamera) row("Surface", "as the camera sees it; right from where it stands");
  if (const auto& s = calibration.surface; s && wall.surface.shape != SurfaceShape::kCamera) {
    row("Surface", fmt::format("{} fiducials fit to {:.3f} {} rms{}", wall.surface.fiducials.size(), s->rms,
                               escaped(wall.surface.wallUnits()),
                               s->bend ? fmt::format("; cylinder of radius {:.1f}", s->bend->radius) : ""));
    if (!calibration.places.empty()) row("Camera places", std::to_string(calibration.places.size() + 1));
  }
  if (wall.isFlat()) row("Screens", "a flat wall: exact, computed from wall.yaml");
  if (rows.empty()) return "";
  return "<div class=\"scroll sheet\"><table><tbody>\n" + rows + kCloseTable;
}

std::string termsHtml() {
  return R"html(<dl class="terms">
<dt>Residual, rms, 95 %, max</dt><dd>What the projector's model leaves of each measured point, in projector pixels.
Arrows at random are noise of the camera; arrows that turn together are a bend that the model does not know.</dd>
<dt>Held-out</dt><dd>The same for points that the fit was not shown: what to expect between the points.</dd>
<dt>Model ±</dt><dd>The model's standard deviation over the frame, from the fit's covariance.</dd>
<dt>Expected seam error</dt><dd>How far the two projectors' pictures of one desktop point are expected to lie apart in
their overlap, in pixels of the coarser one: what their residuals differ by, beyond noise, and what both models may be
off. Worst holds at 95 % of the calibrations. Below 0.25 px edges look single.</dd>
<dt>Narrowest</dt><dd>The width over which one projector fades into the other. Wider blends hide differences in
brightness better.</dd>
<dt>Density</dt><dd>Projector pixels per desktop pixel, along a line. Below 1 small text turns soft; from 1.25 on it is
crisp.</dd>
<dt>Camera px/px</dt><dd>Camera pixels per projector pixel: how finely the camera saw this projector.</dd>
<dt>Rms, steepest</dt><dd>Of luminance: how far white or grey is from its mean over the display, and the largest change
within a degree of view, where the display is 60 degrees wide. From about 1 % a degree on a slow change is seen.</dd>
<dt>ΔE</dt><dd>Colour difference by CIEDE2000, at equal brightness. Below 1 it is not seen side by side, above 3 plainly. The
camera’s channels count as sRGB, so it is as good as they are.</dd>
<dt>Leak</dt><dd>What a projector lights where it shows black, of its white. It adds up in overlaps, whatever the
masks.</dd>
<dt>Gain</dt><dd>What a projector is dimmed to, so that its white is the wall’s.</dd>
</dl>
)html";
}

}  // namespace pixelflex::calib
