#include "tests/bench/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "devices/image/atomic_file.h"

namespace pixelflex::testing {
namespace {

constexpr double kWidth = 440, kHeight = 300;                       // of a frame with its margins
constexpr double kLeft = 62, kRight = 14, kTop = 34, kBottom = 46;  // margins

/// Decades, and where they lie.
class Axis {
 public:
  Axis(double least, double most, double from, double to)
      : low_(std::floor(std::log10(least) + 1e-9)),
        high_(std::max(low_ + 1, std::ceil(std::log10(most) - 1e-9))),
        from_(from),
        to_(to) {}

  [[nodiscard]] double at(double value) const {
    return from_ + (to_ - from_) * (std::log10(value) - low_) / (high_ - low_);
  }
  [[nodiscard]] std::vector<double> decades() const {
    std::vector<double> values;
    for (double power = low_; power <= high_; ++power) values.push_back(std::pow(10, power));
    return values;
  }

 private:
  double low_, high_, from_, to_;
};

std::string secondsText(double seconds) {
  if (seconds < 0.999e-3) return fmt::format("{:.3g} µs", 1e6 * seconds);
  return seconds < 0.999 ? fmt::format("{:.3g} ms", 1e3 * seconds) : fmt::format("{:.3g} s", seconds);
}

std::string countText(double count) {
  return count < 1e4 ? fmt::format("{:.0f}", count) : fmt::format("10^{:.0f}", std::log10(count));
}

std::string text(double x, double y, const std::string& anchor, const std::string& words, int size = 11) {
  return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}' font-size='{}'>{}</text>\n", x, y, anchor, size,
                     words);
}

std::string line(double x1, double y1, double x2, double y2) {
  return fmt::format("<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='#ddd'/>\n", x1, y1, x2, y2);
}

std::string frame(const Curve& curve, double left, double top) {
  const auto [leastX, mostX] = std::ranges::minmax(curve.points, {}, &std::pair<double, double>::first);
  const auto [leastY, mostY] = std::ranges::minmax(curve.points, {}, &std::pair<double, double>::second);
  const Axis x(leastX.first, mostX.first, left + kLeft, left + kWidth - kRight);
  const Axis y(leastY.second, mostY.second, top + kHeight - kBottom, top + kTop);
  std::string svg = text(left + kLeft, top + 20, "start", curve.title, 14);
  for (const double value : x.decades()) {
    svg += line(x.at(value), top + kTop, x.at(value), top + kHeight - kBottom);
    svg += text(x.at(value), top + kHeight - kBottom + 16, "middle", countText(value));
  }
  for (const double value : y.decades()) {
    svg += line(left + kLeft, y.at(value), left + kWidth - kRight, y.at(value));
    svg += text(left + kLeft - 6, y.at(value) + 4, "end", secondsText(value));
  }
  svg += text(left + kWidth - kRight, top + kHeight - 10, "end", curve.across);
  svg += "<polyline fill='none' stroke='#0a5' stroke-width='2' points='";
  for (const auto& [count, seconds] : curve.points) svg += fmt::format("{:.1f},{:.1f} ", x.at(count), y.at(seconds));
  svg += "'/>\n";
  for (const auto& [count, seconds] : curve.points) {
    svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='2.5' fill='#0a5'/>\n", x.at(count), y.at(seconds));
  }
  return svg;
}

}  // namespace

void drawCurves(const std::vector<Curve>& curves, const std::filesystem::path& file) {
  const auto rows = static_cast<double>((curves.size() + 1) / 2);
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0:.0f}' height='{1:.0f}' viewBox='0 0 {0:.0f} {1:.0f}' "
      "font-family='sans-serif'>\n<rect width='100%' height='100%' fill='white'/>\n",
      2 * kWidth, rows * kHeight);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    svg += frame(curves[i], kWidth * static_cast<double>(i % 2), kHeight * static_cast<double>(i / 2));
  }
  devices::writeFileAtomically(file, svg + "</svg>\n");
}

}  // namespace pixelflex::testing
