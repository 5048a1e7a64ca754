#include "calib/report/light_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "calib/photometric/luminance_target.h"
#include "calib/report/audience_pictures.h"
#include "calib/report/html_text.h"
#include "calib/report/light_drawing.h"
#include "calib/report/light_figures.h"
#include "calib/report/overlap_profile.h"

namespace pixelflex::calib {
namespace {

constexpr int kRasterAcross = 960;

WallRaster rasterOf(const Display& display) {
  const double pitch = (display.right - display.left) / kRasterAcross;
  const int rows = std::max(2, static_cast<int>(std::lround((display.bottom - display.top) / pitch)));
  return {{display.left, display.top}, pitch, {kRasterAcross, rows}};
}

/// What the wall shows under a correction.
struct Shown {
  Evenness white, grey;
  double light = 0;  // mean luminance of white
  double black = 0;  // and of black
};

Shown measure(const PredictedView& view, Correction correction) {
  const double perDegree = kRasterAcross / kDisplayDegrees;
  const devices::ImageF white = view.seeField({255, 255, 255}, correction);
  const devices::ImageF grey = view.seeField({128, 128, 128}, correction);
  const devices::ImageF black = view.seeField({0, 0, 0}, correction);
  return {evennessOf(luminanceOf(white), perDegree), evennessOf(luminanceOf(grey), perDegree),
          luminanceOf(meanLight(white)), luminanceOf(meanLight(black))};
}

std::string leakOf(const StoredLight& light) {
  return light.leak ? fmt::format("{:.2f}", 100 * *light.leak) : "–";
}

std::string responseOf(const StoredLight& light) {
  return light.response ? fmt::format("power {:.2f}", gammaOf(*light.response)) : "sRGB assumed";
}

class LightPart {
 public:
  LightPart(const WallLight& light, const Calibration& calibration, const Summary& summary)
      : light_(light),
        display_(*calibration.display),
        summary_(summary),
        view_(light.projectors, light.mappings, rasterOf(display_)),
        bare_(measure(view_, Correction::kNone)),
        masked_(measure(view_, Correction::kShares)),
        whole_(measure(view_, Correction::kWhole)) {
    for (const auto& name : light.names) colours_.push_back(colourOf(summary, name));
  }

  [[nodiscard]] std::string html() const {
    return "<section><h2>Light</h2>\n<p class=\"sub\">Computed from the light, response and leak measured of each "
           "projector and from what is done to them: what the measurements promise, not photographs of the finished "
           "wall." +
           std::string(light_.leftEye ? " Of the left eye’s projectors." : "") + "</p>\n" + facts() + evennessTable() +
           projectorTable() +
           "</section>\n<section class=\"part\"><h2>As the audience sees it</h2>\n<div class=\"sheet\">"
           "<p class=\"sub\">Computed as above, not photographed. The two of a pair are exposed alike, so that the "
           "brightest "
           "overlaps may burn out.</p>\n" +
           audiencePictures(view_, light_, display_, summary_) + "</div></section>\n" + profiles();
  }

 private:
  [[nodiscard]] std::string facts() const {
    std::string html = "<dl class=\"facts\">\n";
    html += fact("Unevenness of white", fmt::format("{:.1f} %", 100 * whole_.white.rms),
                 fmt::format("rms; not calibrated {:.1f} %", 100 * bare_.white.rms));
    if (light_.matched) {
      html += fact("Light kept", fmt::format("{:.0f} %", 100 * whole_.light / masked_.light),
                   "of the mean white that the masks alone would leave");
    }
    if (light_.leakKnown && whole_.black > 0) {
      html += fact("Contrast", fmt::format("{:.0f}:1", whole_.light / whole_.black),
                   light_.evened ? fmt::format("with even black; native {:.0f}:1", whole_.light / masked_.black)
                                 : "native black");
    }
    if (light_.projectors.size() > 1) html += colourFact();
    return html + "</dl>\n";
  }

  [[nodiscard]] std::string colourFact() const {
    const ColourFigures now = compareColours(light_, Correction::kWhole);
    const ColourFigures before = compareColours(light_, Correction::kNone);
    std::string note = "between the two least alike";
    if (light_.matched) note += fmt::format("; before {:.1f}", before.whiteWorst);
    if (now.primariesRms && before.primariesRms) {
      note += fmt::format("; red, green and blue {:.1f} rms", *now.primariesRms);
      if (light_.matched) note += fmt::format(", before {:.1f}", *before.primariesRms);
    }
    return fact("Colour of white", fmt::format("ΔE {:.1f}", now.whiteWorst), note);
  }

  [[nodiscard]] std::string evennessTable() const {
    std::string html =
        openTable("Evenness", {"", "white<br/>rms %", "white<br/>max − min %", "white, steepest<br/>% a degree",
                               "grey 128<br/>rms %", "mean white<br/>masks = 100"});
    const auto row = [&](const char* name, const Shown& shown) {
      html += fmt::format(
          "<tr><th "
          "scope=\"row\">{}</th><td>{:.1f}</td><td>{:.1f}</td><td>{:.1f}</td><td>{:.1f}</td><td>{:.0f}</td></tr>\n",
          name, 100 * shown.white.rms, 100 * shown.white.range, 100 * shown.white.steepest, 100 * shown.grey.rms,
          100 * shown.light / masked_.light);
    };
    row("not calibrated", bare_);
    row(light_.matched ? "masks alone" : "masks", masked_);
    if (light_.matched) row("matched", whole_);
    return html + kCloseTable;
  }

  [[nodiscard]] std::string projectorTable() const {
    std::string html = openTable("Light of the projectors",
                                 {"projector", "white<br/>% of the brightest", "colour of white<br/>ΔE before",
                                  "colour of white<br/>ΔE after", "leak<br/>% of white", "response"});
    const glm::dvec3 before = commonWhite(light_, Correction::kNone);
    const glm::dvec3 after = commonWhite(light_, Correction::kWhole);
    double most = 0;
    for (const auto& own : light_.projectors) most = std::max(most, coloursOf(own, Correction::kNone).level);
    for (std::size_t i = 0; i < light_.projectors.size(); ++i) {
      const auto& own = light_.projectors[i];
      const OwnColours native = coloursOf(own, Correction::kNone);
      const OwnColours matched = coloursOf(own, Correction::kWhole);
      html += fmt::format(
          "<tr><th scope=\"row\">{}{}</th><td>{:.0f}</td><td>{:.1f}</td><td>{:.1f}</td><td>{}</td><td>{}</td></tr>\n",
          chip(colours_[i]), escaped(light_.names[i]), 100 * native.level / most,
          whiteDifference(native.white, before, before), whiteDifference(matched.white, after, after),
          leakOf(own.stored()), responseOf(own.stored()));
    }
    return html + kCloseTable;
  }

  [[nodiscard]] std::string profiles() const {
    std::string figures;
    for (const auto& seam : summary_.seams) {
      if (seam.insideDisplay) figures += profile(seam);
    }
    if (figures.empty()) return "";
    return "<section><h2>Across the overlaps</h2>\n<div class=\"sheet\"><p class=\"sub\">Luminance of white along a "
           "line "
           "through the middle of each overlap (shaded): every projector’s part in its colour, their sum on top; 100 % "
           "is the calibrated wall’s mean." +
           std::string(light_.matched ? " Dotted: the masks alone." : "") + "</p>\n<div class=\"charts\">\n" + figures +
           "</div></div></section>\n";
  }

  [[nodiscard]] std::string profile(const Seam& seam) const {
    const auto first = light_.indexOf(seam.first);
    const auto second = light_.indexOf(seam.second);
    if (!first || !second) return "";
    const auto line = lineAcross(light_.mappings[*first], light_.mappings[*second], display_);
    if (!line) return "";
    const Profile before = profileAlong(*line, light_, Correction::kNone);
    const Profile after = profileAlong(*line, light_, Correction::kWhole);
    const auto masked = light_.matched ? profileAlong(*line, light_, Correction::kShares).sum : std::vector<double>();
    const std::string names = escaped(seam.first) + " and " + escaped(seam.second);
    const auto unlike = differenceOver(*line, *first, *second, light_, Correction::kNone);
    const auto alike = differenceOver(*line, *first, *second, light_, Correction::kWhole);
    return fmt::format(
        "<figure>\n{}<figcaption>{}: white differs by {:.1f} % and ΔE {:.1f}{}.</figcaption></figure>\n",
        drawProfiles({*line, before, after, masked, whole_.light, colours_},
                     "Luminance across the overlap of " + seam.first + " and " + seam.second),
        names, 100 * unlike.luminance, unlike.colour,
        light_.matched ? fmt::format("; matched, by {:.1f} % and ΔE {:.1f}", 100 * alike.luminance, alike.colour) : "");
  }

  const WallLight& light_;
  const Display& display_;
  const Summary& summary_;
  PredictedView view_;
  Shown bare_, masked_, whole_;
  std::vector<std::string> colours_;
};

}  // namespace

std::string lightPart(const WallLight& light, const Calibration& calibration, const Summary& summary) {
  assert(calibration.display.has_value());
  return LightPart(light, calibration, summary).html();
}

}  // namespace pixelflex::calib
