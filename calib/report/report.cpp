#include "calib/report/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/procedure/verdicts.h"
#include "calib/report/html_text.h"
#include "calib/report/light_drawing.h"
#include "calib/report/light_part.h"
#include "calib/report/photo_drawing.h"
#include "calib/report/plan_drawing.h"
#include "calib/report/projector_drawing.h"
#include "calib/report/report_style.h"
#include "calib/report/report_tables.h"
#include "calib/report/wall_drawing.h"
#include "calib/report/wall_light.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;

std::string figure(const std::string& place, const std::string& drawing, const std::string& caption) {
  if (drawing.empty()) return "";
  return fmt::format("<figure class=\"{}\">\n{}<figcaption>{}</figcaption></figure>\n", place, drawing, caption);
}

std::string maskOf(const fs::path& folder, const ProjectorCalibration& projector) {
  const devices::Image16 mask = readStoredMap(folder, projector.alpha);
  return mask.empty() ? "" : drawMask(mask);
}

std::string cameraError(const ProjectorCalibration& projector) {
  if (!projector.responseError) return "";
  return fmt::format(", by the camera to {:.1f} % of light", 100 * *projector.responseError);
}

/// Response, gain and lift of black: what is done to a projector's light besides its mask.
std::string lightFigures(const fs::path& folder, const ProjectorCalibration& projector) {
  std::string html;
  if (const auto response = readStoredResponse(folder, projector)) {
    html += figure("third", drawResponse(*response, projector.name),
                   fmt::format("Response of the three channels, nearest to the power {:.2f}{}. Dashed: sRGB.",
                               gammaOf(*response), cameraError(projector)));
  }
  if (!projector.light) return html;
  const auto gain = drawStretched(readStoredMap(folder, projector.light->gain), "Gain");
  html += figure("third", gain.picture, fmt::format("Gain: {:.2f} (black) to {:.2f} (white).", gain.least, gain.most));
  const auto lift = drawStretched(readStoredMap(folder, projector.light->black), "Lift of black");
  const auto& largest = projector.light->largestBlack;
  const double percent = 100 * std::ranges::max(largest);
  return html + figure("third", lift.picture,
                       fmt::format("Lift of black: {:.2f} % (black) to {:.2f} % of white (white).",
                                   percent * lift.least, percent * lift.most));
}

std::string photoCaption(const FitQuality& quality) {
  const int missing = quality.shown - quality.found;
  return fmt::format("In the camera’s photograph: {} of {} points found{}.", quality.found, quality.shown,
                     missing > 0 ? ", crosses where one is missing" : "");
}

std::string numbers(const ProjectorSummary& p, bool responseMeasured) {
  std::string list = "<dl class=\"numbers\">\n";
  const auto add = [&](const char* term, const std::string& text) {
    list += fmt::format("<dt>{}</dt><dd>{}</dd>\n", term, text);
  };
  const FitQuality& q = p.quality;
  add("points found", fmt::format("{} of {}", q.found, q.shown));
  add("residual rms / max", fmt::format("{:.3f} / {:.3f} px", q.rms, q.maximum));
  if (q.heldOut > 0) add("held-out rms", fmt::format("{:.3f} px", q.heldOut));
  if (q.deviation > 0) add("model ±", fmt::format("{:.3f} px", q.deviation));
  if (q.cameraScale > 0) add("camera px per px", fmt::format("{:.2f}", q.cameraScale));
  if (p.desktopDensity > 0) add("px per desktop px", fmt::format("{:.2f}", p.desktopDensity));
  if (!responseMeasured) add("response", "sRGB assumed");
  add("overlapped", fmt::format("{:.1f} %", p.overlapPercent));
  add("in the display", fmt::format("{:.1f} %", p.displayPercent));
  return list + "</dl>\n";
}

std::string modelOf(const ProjectorModel& model) {
  return fmt::format(
      "model: homography, lens k {:.4f} {:.4f} {:.4f}, p {:.5f} {:.5f}, centre {:.1f} / {:.1f}{}{}", model.radial[0],
      model.radial[1], model.radial[2], model.tangential[0], model.tangential[1], model.centre.x, model.centre.y,
      model.bend ? ", bent screen" : "",
      model.residual ? fmt::format(", residual spline of {} × {} cells", model.residual->columns, model.residual->rows)
                     : "");
}

std::string badge(const std::string& name, const std::vector<Finding>& findings) {
  const auto found = std::ranges::find(findings, name, &Finding::where);  // the bad ones come first
  if (found == findings.end()) return "<span class=\"tag good\">good</span>";
  const char* word = found->severity == Severity::kBad ? "bad" : "notice";
  return fmt::format("<span class=\"tag {0}\">{0}</span>", word);
}

class ReportPage {
 public:
  ReportPage(const fs::path& folder, const Wall& wall, const Calibration& calibration, const Summary& summary)
      : folder_(folder),
        wall_(wall),
        calibration_(calibration),
        summary_(summary),
        findings_(judge(wall, calibration, summary)) {}

  [[nodiscard]] std::string html() const {
    return head() + opening() + wallPart() + densityPart() + light() + tables() + projectors() +
           "<section class=\"part\"><h2>What the words mean</h2>\n<div class=\"sheet\">" + termsHtml() +
           "</div></section>\n<footer>Written by pixelflex calibrate.</footer>\n</main></body></html>\n";
  }

 private:
  [[nodiscard]] std::string title() const {
    std::error_code ignored;
    const fs::path whole = fs::absolute(folder_, ignored);
    const fs::path name = whole.has_filename() ? whole.filename() : whole.parent_path().filename();
    return "Calibration of " + (name.empty() ? "the wall" : name.string());
  }

  [[nodiscard]] std::string head() const {
    std::string text = kReportHead;
    const std::string mark = "%TITLE%";
    text.replace(text.find(mark), mark.size(), escaped(title()));
    return text + kReportPatterns;
  }

  [[nodiscard]] std::string opening() const {
    const bool bad = !findings_.empty() && findings_.front().severity == Severity::kBad;
    return fmt::format(
        "<main>\n<h1>{}</h1>\n<p class=\"verdict {}\">{}</p>\n{}<section>\n<h2>Verdict</h2>\n{}</section>\n",
        escaped(title()),
        bad                 ? "bad"
        : findings_.empty() ? "good"
                            : "notice",
        escaped(verdict(summary_, findings_)), factsHtml(wall_, calibration_, summary_), findingsHtml(findings_));
  }

  [[nodiscard]] std::string wallPart() const {
    const std::string drawing = drawWall(wall_, calibration_, summary_);
    if (drawing.empty()) return "";
    std::string caption = "As the audience sees it. Dashed: the display, filled by the desktop.";
    if (!wall_.surface.fiducials.empty() && !wall_.isFlat()) caption += " Crosses: fiducials.";
    if (summary_.lit.islands.size() > 1) {
      caption += fmt::format(" The lit area falls into {} parts.", summary_.lit.islands.size());
    }
    if (!summary_.lit.holes.empty()) caption += " Hatched: lit by no projector.";
    return "<section class=\"part\"><h2>The wall</h2>\n<div class=\"sheet\">" + figure("front", drawing, caption) +
           figure("plan", drawPlan(calibration_, summary_), "From above: the screen, and what each projector lights.") +
           "</div></section>\n";
  }

  [[nodiscard]] std::string densityPart() const {
    const std::string drawing = drawWallDensity(wall_, calibration_, summary_);
    if (drawing.empty()) return "";
    return "<section class=\"part\"><h2>Sharpness</h2>\n<div class=\"sheet\">" +
           figure("front", drawing,
                  "Projector pixels per desktop pixel. Below 1 (the full line) small text is soft; from 1.25 (the "
                  "dashed line) it is crisp. Where projectors overlap, as the blend mixes them.") +
           "</div></section>\n";
  }

  [[nodiscard]] std::string light() const {
    const auto light = readWallLight(folder_, wall_, calibration_);
    return light ? lightPart(*light, calibration_, summary_) : "";
  }

  [[nodiscard]] std::string tables() const {
    const std::string measurement = measurementTable(wall_, calibration_);
    return "<section><h2>Overlaps</h2>\n" + seamTable(summary_, findings_) + "</section>\n<section><h2>Figures</h2>\n" +
           projectorTable(wall_, summary_) + "</section>\n" +
           (measurement.empty() ? "" : "<section><h2>Camera and surface</h2>\n" + measurement + "</section>\n");
  }

  [[nodiscard]] std::string projectors() const {
    std::string html = "<section class=\"projectors\"><h2>Projectors</h2>\n";
    for (std::size_t i = 0; i < summary_.projectors.size(); ++i) html += article(i);
    return html + "</section>\n";
  }

  [[nodiscard]] std::string article(std::size_t index) const {
    const auto& p = summary_.projectors[index];
    const auto* projector = calibration_.find(p.name);
    std::string html = fmt::format(
        "<article class=\"sheet\"><header><h3><span class=\"chip\" style=\"background:{}\"></span>{}</h3>{}",
        colourOf(index), escaped(p.name), badge(p.name, findings_));
    if (projector == nullptr) return html + "<span class=\"sub\">not calibrated</span></header></article>\n";
    html += fmt::format("<span class=\"sub\">{} × {}</span></header>\n{}<div class=\"figures\">\n",
                        projector->resolution.width, projector->resolution.height, remarks(p.name));
    const std::string photo = drawPhotograph(folder_, calibration_, *projector);
    const std::string residuals = figure(photo.empty() ? "third" : "high", drawResiduals(*projector),
                                         "Residuals: from where a point was shown to where the model has it.");
    html += figure("wide", photo, photoCaption(p.quality)) + residuals;
    html += "<div class=\"third\">" + numbers(p, projector->response || projector->flatAt) + "</div>\n";
    if (calibration_.display) {
      const auto density = drawDensity(*projector, *calibration_.display);
      html += figure("third", density.svg,
                     fmt::format("Density: {:.2f} to {:.2f} px per desktop pixel.", density.least, density.most));
    }
    html += figure("third", maskOf(folder_, *projector), "Blend mask.") + lightFigures(folder_, *projector);
    return html + "</div>\n<p class=\"sub\">" + modelOf(projector->model) + "</p></article>\n";
  }

  /// What is not good about one projector; cause and cure stand in the verdict above.
  [[nodiscard]] std::string remarks(const std::string& name) const {
    std::string html;
    for (const auto& finding : findings_) {
      if (finding.where == name) html += "<p class=\"remark\">" + escaped(finding.what) + ".</p>\n";
    }
    return html;
  }

  const fs::path& folder_;
  const Wall& wall_;
  const Calibration& calibration_;
  const Summary& summary_;
  std::vector<Finding> findings_;
};

}  // namespace

std::string reportHtml(const fs::path& folder, const Wall& wall, const Calibration& calibration,
                       const Summary& summary) {
  return ReportPage(folder, wall, calibration, summary).html();
}

}  // namespace pixelflex::calib
