#include "calib/report/light_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/photometric/predicted_view.h"
#include "calib/report/html_text.h"
#include "calib/report/picture_uri.h"

namespace pixelflex::calib {
namespace {

// Of a chart, in its own units: 100 by 75 with room for figures to the left and below.
constexpr double kWidth = 100;
constexpr double kHeight = 75;

double rootOf(double light) {
  return std::pow(std::max(light, 0.0), 1 / 2.2);
}

std::string curve(const std::array<double, 256>& light) {
  std::string path;
  for (std::size_t code = 0; code < 256; code += code == 254 ? 1 : 2) {
    path += fmt::format("{}{:.1f} {:.1f}", code == 0 ? "M" : "L", kWidth * static_cast<double>(code) / 255,
                        kHeight * (1 - rootOf(light.at(code))));
  }
  return path;
}

std::string responseGrid() {
  std::string svg = fmt::format("<rect class=\"paper\" width=\"{}\" height=\"{}\"/>\n", kWidth, kHeight);
  for (const double light : {0.01, 0.05, 0.2, 0.5, 1.0}) {
    const double y = kHeight * (1 - rootOf(light));
    svg += fmt::format(
        "<path class=\"grid\" d=\"M0 {0:.1f}H{1}\" stroke-width=\"0.3\"/><text x=\"-1.5\" y=\"{2:.1f}\" "
        "text-anchor=\"end\" font-size=\"4.6\">{3:.0f} %</text>\n",
        y, kWidth, y + 1.6, 100 * light);
  }
  for (const int code : {0, 64, 128, 192, 255}) {
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\" font-size=\"4.6\">{}</text>\n",
                       kWidth * code / 255.0, kHeight + 5.5, code);
  }
  return svg;
}

/// The sum of projectors' light in one half of a drawing.
class ProfilePanel {
 public:
  ProfilePanel(const ProfileDrawing& drawing, double left, double largest)
      : drawing_(drawing), left_(left), largest_(largest) {}

  [[nodiscard]] std::string draw(const Profile& profile, const std::string& title) const {
    std::string svg = fmt::format(
        "<rect class=\"paper\" x=\"{0:.1f}\" width=\"{1}\" height=\"{2}\"/><rect class=\"shared\" x=\"{3:.1f}\" "
        "width=\"{4:.1f}\" height=\"{2}\"/><text x=\"{5:.1f}\" y=\"{6}\" text-anchor=\"middle\" "
        "font-size=\"7\">{7}</text>\n",
        left_, kWidth, kHeight, x(drawing_.line.overlapBegin),
        x(drawing_.line.overlapEnd) - x(drawing_.line.overlapBegin), left_ + kWidth / 2, kHeight + 8, title);
    for (int percent = 0; percent <= 100 * largest_; percent += largest_ > 2.5 ? 100 : 50) {
      svg += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}h{}\" stroke-width=\"0.3\"/>", left_,
                         y(percent / 100.0 * drawing_.white), kWidth);
    }
    for (const auto& part : profile.parts) {
      svg += fmt::format("<path class=\"line\" d=\"{}\" stroke=\"{}\" stroke-width=\"1.1\"/>\n", path(part.luminance),
                         drawing_.colours.at(part.projector));
    }
    return svg + fmt::format("<path class=\"line sum\" d=\"{}\" stroke-width=\"1.1\"/>\n", path(profile.sum));
  }

  [[nodiscard]] std::string path(const std::vector<double>& luminance) const {
    std::string text;
    for (std::size_t i = 0; i < luminance.size(); ++i) {
      const double along = static_cast<double>(i) / static_cast<double>(luminance.size() - 1);
      text += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", left_ + kWidth * along, y(luminance[i]));
    }
    return text;
  }

  [[nodiscard]] double y(double luminance) const { return kHeight * (1 - luminance / (drawing_.white * largest_)); }

 private:
  [[nodiscard]] double x(double distance) const {
    return left_ + kWidth * (distance - drawing_.line.begin) / (drawing_.line.end - drawing_.line.begin);
  }

  const ProfileDrawing& drawing_;
  double left_;
  double largest_;  // of the scale, times white
};

double largestOf(const ProfileDrawing& drawing) {
  const double most = std::max(std::ranges::max(drawing.before.sum), std::ranges::max(drawing.after.sum));
  return std::ceil(2.1 * most / drawing.white) / 2;
}

}  // namespace

std::string drawResponse(const ResponseCurve& response, const std::string& projector) {
  std::array<double, 256> ideal{};
  for (std::size_t code = 0; code < 256; ++code) ideal.at(code) = lightOfSrgb(static_cast<std::uint8_t>(code));
  std::string svg =
      fmt::format("<svg class=\"chart\" viewBox=\"-16 -4 {} {}\" role=\"img\" aria-label=\"Response of {}\">\n",
                  kWidth + 21, kHeight + 12, escaped(projector));
  svg += responseGrid();
  svg += fmt::format("<path class=\"line ideal\" d=\"{}\" stroke-width=\"0.9\" stroke-dasharray=\"2 1.5\"/>\n",
                     curve(ideal));
  constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};
  for (std::size_t c = 0; c < 3; ++c) {
    svg += fmt::format("<path class=\"line {}\" d=\"{}\" stroke-width=\"0.9\"/>\n", kChannels.at(c),
                       curve(response.light.at(c)));
  }
  return svg + "</svg>\n";
}

double gammaOf(const ResponseCurve& response) {
  double products = 0, squares = 0;
  for (const auto& light : response.light) {
    for (std::size_t code = 20; code <= 235; ++code) {
      if (light.at(code) <= 0) continue;
      const double in = std::log(static_cast<double>(code) / 255);
      products += in * std::log(light.at(code));
      squares += in * in;
    }
  }
  return squares > 0 ? products / squares : 0;
}

std::string drawProfiles(const ProfileDrawing& drawing, const std::string& label) {
  constexpr double kGap = 6;
  const double largest = largestOf(drawing);
  const ProfilePanel before(drawing, 0, largest);
  const ProfilePanel after(drawing, kWidth + kGap, largest);
  std::string svg = fmt::format("<svg class=\"chart\" viewBox=\"-22 -4 {} {}\" role=\"img\" aria-label=\"{}\">\n",
                                2 * kWidth + kGap + 24, kHeight + 14, escaped(label));
  svg += before.draw(drawing.before, "not calibrated") + after.draw(drawing.after, "calibrated");
  if (!drawing.masked.empty()) {
    svg += fmt::format("<path class=\"line sum\" d=\"{}\" stroke-width=\"0.7\" stroke-dasharray=\"1 1.4\"/>\n",
                       after.path(drawing.masked));
  }
  for (int percent = 0; percent <= 100 * largest; percent += 100) {
    svg += fmt::format("<text x=\"-1.5\" y=\"{:.1f}\" text-anchor=\"end\" font-size=\"6.5\">{} %</text>\n",
                       before.y(percent / 100.0 * drawing.white) + 2.2, percent);
  }
  return svg + "</svg>\n";
}

MapDrawing drawStretched(const devices::Image16& map, const std::string& label) {
  if (map.empty()) return {};
  const auto [low, high] = std::ranges::minmax(map.samples());
  constexpr int kLargest = 128;
  const int columns = std::min(kLargest, map.width());
  const int rows = std::max(1, columns * map.height() / map.width());
  devices::Image8 small({columns, rows}, 1);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int x = (2 * column + 1) * map.width() / (2 * columns);
      const int y = (2 * row + 1) * map.height() / (2 * rows);
      small.at(column, row) =
          high > low ? static_cast<std::uint8_t>((map.at(x, y) - low) * 255 / (high - low)) : std::uint8_t{255};
    }
  }
  return {fmt::format("<img class=\"frame\" src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\"/>\n", pictureUri(small),
                      columns, rows, escaped(label)),
          low / 65535.0, high / 65535.0};
}

}  // namespace pixelflex::calib
