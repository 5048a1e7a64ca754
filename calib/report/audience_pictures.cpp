#include "calib/report/audience_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "calib/report/html_text.h"
#include "calib/report/light_figures.h"
#include "calib/report/overlap_profile.h"
#include "calib/report/picture_uri.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::ImageF;

std::uint8_t codeOfLight(double light) {
  const double l = std::clamp(light, 0.0, 1.0);
  const double code = l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * code));
}

/// As a camera would take it: `full` of each channel is as bright as the picture can be.
Image8 developed(const ImageF& view, glm::dvec3 full) {
  constexpr std::size_t kSteps = 4096;
  static const auto codes = [] {
    std::array<std::uint8_t, kSteps + 1> table{};
    for (std::size_t i = 0; i <= kSteps; ++i) table.at(i) = codeOfLight(std::pow(double(i) / kSteps, 2));
    return table;
  }();
  Image8 picture(view.size(), 3);
  for (std::size_t i = 0; i < picture.samples().size(); ++i) {
    const double light = std::clamp(view.samples()[i] / full[static_cast<glm::length_t>(i % 3)], 0.0, 1.0);
    picture.samples()[i] = codes.at(static_cast<std::size_t>(std::lround(std::sqrt(light) * kSteps)));
  }
  return picture;
}

Image8 rampOf(devices::Size size) {
  Image8 ramp(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto code = static_cast<std::uint8_t>(256LL * x / size.width);
      for (int c = 0; c < 3; ++c) ramp.at(x, y, c) = code;
    }
  }
  return ramp;
}

Image8 textOf(devices::Size size) {
  Image8 page(size, 3);
  cv::Mat pixels(size.height, size.width, CV_8UC3, page.samples().data());
  pixels.setTo(cv::Scalar(246, 246, 244));
  constexpr std::array<const char*, 4> kLines = {
      "The quick brown fox jumps over the lazy dog, and the dog sleeps on: 0123456789",
      "for (int i = 0; i < count; ++i) sum += weight[i] * value[i];  // no seam",
      "Sphinx of black quartz, judge my vow. Pack my box with five dozen liquor jugs.",
      "ABCDEFGHIJKLMNOPQRSTUVWXYZ abcdefghijklmnopqrstuvwxyz (){}[]<>+-*/=%&|!?"};
  constexpr int kLineHeight = 22;
  for (int y = 18, line = 0; y < size.height; y += kLineHeight, ++line) {
    cv::putText(pixels, kLines.at(static_cast<std::size_t>(line) % kLines.size()), {8 - 40 * (line % 3), y},
                cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar(24, 24, 28), 1, cv::LINE_AA);
  }
  return page;
}

std::string picture(const Image8& image, const std::string& title, const char* when) {
  return fmt::format(
      "<div><span class=\"sub\">{0}</span><img class=\"frame\" src=\"{1}\" width=\"{2}\" height=\"{3}\" "
      "alt=\"{4}, {0}\"/></div>\n",
      when, jpegUri(image), image.width(), image.height(), escaped(title));
}

/// Luminance that all but one of 200 pixels stay below.
double brightest(const ImageF& view) {
  const ImageF luminance = luminanceOf(view);
  std::vector<float> values(luminance.samples().begin(), luminance.samples().end());
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 199 / 200);
  std::ranges::nth_element(values, place);
  return *place;
}

class AudiencePictures {
 public:
  AudiencePictures(const PredictedView& view, const WallLight& light, const Display& display, const Summary& summary)
      : view_(view), light_(light), display_(display), summary_(summary) {}

  [[nodiscard]] std::string html() const {
    const ImageF before = view_.seeField({255, 255, 255}, Correction::kNone);
    const ImageF after = view_.seeField({255, 255, 255}, Correction::kWhole);
    const glm::dvec3 white = meanLight(after);
    // White of the calibrated wall is to look white: brighter overlaps may burn out.
    const glm::dvec3 full = white * std::clamp(brightest(before) / luminanceOf(white), 1.0, 1.8);
    std::string text = figure("White", "", before, after, full);
    text += figure("Grey 128", "", view_.seeField({128, 128, 128}, Correction::kNone),
                   view_.seeField({128, 128, 128}, Correction::kWhole), full);
    if (light_.leakKnown) text += black(white);
    const Image8 ramp = rampOf(view_.raster().size);
    text += figure("Ramp from black to white", "", view_.see(ramp, Correction::kNone),
                   view_.see(ramp, Correction::kWhole), full);
    return text + crop(full);
  }

 private:
  [[nodiscard]] static std::string figure(const std::string& title, const std::string& note, const ImageF& before,
                                          const ImageF& after, glm::dvec3 full) {
    return fmt::format(
        "<figure class=\"pair\">\n<div class=\"both\">{}{}</div><figcaption>{}.{}</figcaption></figure>\n",
        picture(developed(before, full), title, "not calibrated"), picture(developed(after, full), title, "calibrated"),
        title, note);
  }

  [[nodiscard]] std::string black(glm::dvec3 white) const {
    const ImageF before = view_.seeField({0, 0, 0}, Correction::kNone);
    const ImageF after = view_.seeField({0, 0, 0}, Correction::kWhole);
    const double most = std::max(brightest(before), brightest(after));
    if (most <= 0) return "";
    const double full = 2 * most / luminanceOf(white);
    return figure("Black",
                  fmt::format(" Brightened {:.0f} times beside the others.{}", 1 / full,
                              light_.evened ? "" : " It is left as the projectors leak: <code>black: native</code>."),
                  before, after, white * full);
  }

  /// Two projectors whose pictures are expected to part.
  struct Parting {
    std::size_t first = 0, second = 0;
    double error = 0;  // pixels of the coarser projector, rms
    double worst = 0;
    OverlapLine line;
  };

  [[nodiscard]] std::optional<Parting> partingAt(const Seam& seam) const {
    const auto first = light_.indexOf(seam.first);
    const auto second = light_.indexOf(seam.second);
    if (!seam.insideDisplay || !first || !second) return std::nullopt;
    const auto line = lineAcross(light_.mappings[*first], light_.mappings[*second], display_);
    if (!line) return std::nullopt;
    return Parting{*first, *second, seam.expectedRms, seam.expectedWorst, *line};
  }

  /// The overlap that is expected to fit worst; none where no two overlap.
  [[nodiscard]] std::optional<Parting> worstParting() const {
    std::optional<Parting> worst;
    for (const auto& seam : summary_.seams) {
      const auto parting = partingAt(seam);
      if (parting && (!worst || parting->worst > worst->worst)) worst = parting;
    }
    return worst;
  }

  [[nodiscard]] WallRaster cropAround(glm::dvec2 middle) const {
    const double pitch = 1 / desktopPixelsPerUnit(display_);
    const devices::Size size{std::min(520, display_.resolution.width), std::min(156, display_.resolution.height)};
    const glm::dvec2 extent = pitch * glm::dvec2(size.width, size.height);
    const glm::dvec2 low(display_.left, display_.top);
    const glm::dvec2 last = glm::dvec2(display_.right, display_.bottom) - extent;
    return {glm::clamp(middle - extent / 2.0, low, glm::max(low, last)), pitch, size};
  }

  /// Half of the expected error for each of the two projectors, in desktop pixels.
  [[nodiscard]] std::vector<glm::dvec2> offsetsAt(const Parting& parting) const {
    const double perUnit = desktopPixelsPerUnit(display_);
    const double coarser =
        std::min(light_.mappings[parting.first].meanDensity(), light_.mappings[parting.second].meanDensity());
    const glm::dvec2 half = 0.5 * parting.error * perUnit / coarser * parting.line.along;
    std::vector<glm::dvec2> offsets(light_.projectors.size(), glm::dvec2(0));
    offsets[parting.first] = -half;
    offsets[parting.second] = half;
    return offsets;
  }

  [[nodiscard]] std::string crop(glm::dvec3 full) const {
    glm::dvec2 middle(0.5 * (display_.left + display_.right), 0.5 * (display_.top + display_.bottom));
    std::vector<glm::dvec2> offsets(light_.projectors.size(), glm::dvec2(0));
    std::string note = " A part of the desktop, a pixel a pixel.";
    if (const auto worst = worstParting()) {
      middle = worst->line.middle;
      offsets = offsetsAt(*worst);
      note = fmt::format(
          " A part of the desktop around the overlap of {} and {}, a pixel a pixel, doubled there by the seam error to "
          "be "
          "expected, {:.2f} px.",
          escaped(light_.names[worst->first]), escaped(light_.names[worst->second]), worst->error);
    }
    const PredictedView near(light_.projectors, light_.mappings, cropAround(middle));
    const Image8 text = textOf(near.raster().size);
    return figure("Text", note, near.see(text, Correction::kNone, offsets), near.see(text, Correction::kWhole, offsets),
                  full);
  }

  const PredictedView& view_;
  const WallLight& light_;
  const Display& display_;
  const Summary& summary_;
};

}  // namespace

std::string audiencePictures(const PredictedView& view, const WallLight& light, const Display& display,
                             const Summary& summary) {
  return AudiencePictures(view, light, display, summary).html();
}

}  // namespace pixelflex::calib
