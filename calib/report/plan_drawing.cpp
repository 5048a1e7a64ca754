#include "calib/report/plan_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <vector>

#include "calib/report/html_text.h"

namespace pixelflex::calib {
namespace {

/// A part of the screen, in wall x.
struct Span {
  double left = 0;
  double right = 0;
};

class PlanDrawing {
 public:
  explicit PlanDrawing(const Bend& bend) : bend_(bend) {}

  [[nodiscard]] std::string draw(const Summary& summary) {
    const Span screen = screenOf(summary);
    unit_ = (screen.right - screen.left) / 100;
    const std::string arc = path(screen, 0);
    svg_ = fmt::format("<path class=\"rule\" d=\"{}\" stroke-width=\"{:.2f}\"/>\n", arc, 0.6 * unit_);
    for (std::size_t i = 0; i < summary.projectors.size(); ++i) {
      const auto& projector = summary.projectors[i];
      if (projector.calibrated) drawProjector(projector.name, colourOf(i), spanOf(projector.outline));
    }
    const glm::dvec2 margin(3 * unit_);
    const glm::dvec2 size = high_ - low_ + 2.0 * margin;
    return fmt::format(
               "<svg class=\"wall\" viewBox=\"{:.1f} {:.1f} {:.1f} {:.1f}\" role=\"img\" aria-label=\"The bent screen "
               "from above\">\n",
               low_.x - margin.x, low_.y - margin.y, size.x, size.y) +
           svg_ + "</svg>\n";
  }

 private:
  [[nodiscard]] static Span spanOf(const Outline& outline) {
    const auto [left, right] = std::ranges::minmax(outline, {}, &glm::dvec2::x);
    return {left.x, right.x};
  }

  [[nodiscard]] static Span screenOf(const Summary& summary) {
    Span all{1e300, -1e300};
    for (const auto& projector : summary.projectors) {
      if (!projector.calibrated) continue;
      const Span own = spanOf(projector.outline);
      all = {std::min(all.left, own.left), std::max(all.right, own.right)};
    }
    return all;
  }

  /// A place this far before the screen. Up is away from the audience.
  [[nodiscard]] glm::dvec2 place(double wallX, double before) {
    const double t = (wallX - bend_.apex) / bend_.radius;
    const double reach = bend_.radius - before;
    const glm::dvec2 at(reach * std::sin(t), bend_.radius - reach * std::cos(t));
    low_ = glm::min(low_, at);
    high_ = glm::max(high_, at);
    return at;
  }

  [[nodiscard]] std::string path(Span span, double before) {
    constexpr int kSteps = 32;
    std::string text;
    for (int i = 0; i <= kSteps; ++i) {
      const glm::dvec2 p = place(span.left + (span.right - span.left) * i / kSteps, before);
      text += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", p.x, p.y);
    }
    return text;
  }

  /// The lane nearest to the screen where no other projector is in the way.
  [[nodiscard]] double laneFor(Span span) {
    const auto meets = [&](const Span& other) { return other.left < span.right && span.left < other.right; };
    std::size_t lane = 0;
    while (lane < lanes_.size() && std::ranges::any_of(lanes_[lane], meets)) ++lane;
    if (lane == lanes_.size()) lanes_.emplace_back();
    lanes_[lane].push_back(span);
    return (1.6 + 3.4 * static_cast<double>(lane)) * unit_;
  }

  void drawProjector(const std::string& name, const std::string& colour, Span span) {
    const double before = laneFor(span);
    svg_ += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\"/>\n", path(span, before),
                        colour, 0.8 * unit_);
    const glm::dvec2 at = place((span.left + span.right) / 2, before + 2.2 * unit_);
    svg_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.2f}\" text-anchor=\"middle\">{}</text>\n", at.x,
                        at.y, 1.8 * unit_, escaped(name));
  }

  const Bend& bend_;
  double unit_ = 1;  // a hundredth of the screen's length
  std::vector<std::vector<Span>> lanes_;
  glm::dvec2 low_{1e300};
  glm::dvec2 high_{-1e300};
  std::string svg_;
};

}  // namespace

std::string drawPlan(const Calibration& calibration, const Summary& summary) {
  if (!calibration.surface || !calibration.surface->bend) return "";
  if (std::ranges::none_of(summary.projectors, &ProjectorSummary::calibrated)) return "";
  return PlanDrawing(*calibration.surface->bend).draw(summary);
}

}  // namespace pixelflex::calib
