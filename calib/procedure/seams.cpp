#include "calib/procedure/seams.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "calib/geometry/footprint.h"
#include "calib/procedure/fit_uncertainty.h"

namespace pixelflex::calib {
namespace {

constexpr int kLattice = 64;   // points a side over an overlap's bounding box
constexpr int kStations = 96;  // along and across a blend
/// A length of two normal components of total variance v stays below sqrt(v) times this at 95 %.
constexpr double kBound95 = 1.731;

struct Box {
  glm::dvec2 low{1e300};
  glm::dvec2 high{-1e300};
  void include(glm::dvec2 p) { low = glm::min(low, p), high = glm::max(high, p); }
  [[nodiscard]] bool empty() const { return !(low.x < high.x && low.y < high.y); }
  [[nodiscard]] bool holds(glm::dvec2 p) const {
    return p.x >= low.x && p.y >= low.y && p.x <= high.x && p.y <= high.y;
  }
};

Box common(const Box& a, const Box& b) {
  return {glm::max(a.low, b.low), glm::min(a.high, b.high)};
}

/// One projector with all that its seams ask for.
struct Site {
  explicit Site(const ProjectorCalibration& projector)
      : name(projector.name), mapping(projector), uncertainty(projector), density(mapping.meanDensity()) {
    const Outline outline = footprint(mapping);
    for (const auto& point : outline) box.include(point);
    area = areaOf(outline);
  }
  [[nodiscard]] bool lights(glm::dvec2 pointInWall) const {
    if (!box.holds(pointInWall)) return false;
    const auto p = mapping.projectorFromWall(pointInWall);
    return p && mapping.insideFrame(*p);
  }
  std::string name;
  ProjectorMapping mapping;
  FitUncertainty uncertainty;
  double density;
  double area = 0;
  Box box;
};

struct Axes {
  glm::dvec2 centre{0, 0};
  glm::dvec2 along{1, 0};
  glm::dvec2 across{0, 1};
  Box extent;  // in along, across about the centre
};

/// The directions in which the points spread most and least.
Axes axesOf(const std::vector<glm::dvec2>& points, glm::dvec2 step) {
  Axes axes;
  for (const auto& p : points) axes.centre += p / static_cast<double>(points.size());
  double xx = 0, xy = 0, yy = 0;
  for (const auto& p : points) {
    const glm::dvec2 d = p - axes.centre;
    xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  axes.along = {std::cos(angle), std::sin(angle)};
  axes.across = {-axes.along.y, axes.along.x};
  for (const auto& p : points) {
    axes.extent.include({glm::dot(p - axes.centre, axes.along), glm::dot(p - axes.centre, axes.across)});
  }
  axes.extent.low -= step;  // the overlap may reach on to the next lattice point
  axes.extent.high += step;
  return axes;
}

class SeamFinder {
 public:
  explicit SeamFinder(const Calibration& calibration) : display_(calibration.display) {
    for (const auto& projector : calibration.projectors) sites_.emplace_back(projector);
  }

  [[nodiscard]] std::vector<Seam> find() const {
    std::vector<Seam> seams;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      for (std::size_t j = i + 1; j < sites_.size(); ++j) {
        if (const auto seam = between(sites_[i], sites_[j])) seams.push_back(*seam);
      }
    }
    return seams;
  }

 private:
  [[nodiscard]] std::optional<Seam> between(const Site& a, const Site& b) const {
    const Box box = common(a.box, b.box);
    if (box.empty()) return std::nullopt;
    const glm::dvec2 step = (box.high - box.low) / double{kLattice};
    const auto lit = pointsLitByBoth(a, b, box, step);
    const double smaller = std::min(a.area, b.area);
    const double area = static_cast<double>(lit.size()) * step.x * step.y;
    if (area <= 1e-4 * smaller) return std::nullopt;
    Seam seam{.first = a.name, .second = b.name, .overlapPercent = 100 * area / smaller};
    seam.sharedPercent = sharedPercent(a, b, lit);
    seam.densityRatio = std::max(a.density, b.density) / std::min(a.density, b.density);
    describeVisible(a, b, lit, step, seam);
    return seam;
  }

  [[nodiscard]] static std::vector<glm::dvec2> pointsLitByBoth(const Site& a, const Site& b, const Box& box,
                                                               glm::dvec2 step) {
    std::vector<glm::dvec2> lit;
    for (int row = 0; row < kLattice; ++row) {
      for (int column = 0; column < kLattice; ++column) {
        const glm::dvec2 point = box.low + step * glm::dvec2(column + 0.5, row + 0.5);
        if (a.lights(point) && b.lights(point)) lit.push_back(point);
      }
    }
    return lit;
  }

  [[nodiscard]] double sharedPercent(const Site& a, const Site& b, const std::vector<glm::dvec2>& lit) const {
    const auto shared = std::ranges::count_if(lit, [&](glm::dvec2 point) {
      return std::ranges::any_of(
          sites_, [&](const Site& other) { return &other != &a && &other != &b && other.lights(point); });
    });
    return 100 * static_cast<double>(shared) / static_cast<double>(lit.size());
  }

  [[nodiscard]] bool shown(glm::dvec2 p) const {
    return display_ && p.x >= display_->left && p.x <= display_->right && p.y >= display_->top &&
           p.y <= display_->bottom;
  }

  void describeVisible(const Site& a, const Site& b, std::vector<glm::dvec2> lit, glm::dvec2 step, Seam& seam) const {
    std::erase_if(lit, [this](glm::dvec2 point) { return !shown(point); });
    if (lit.empty() || !display_) return;
    seam.insideDisplay = true;
    seam.narrowest =
        narrowest(a, b, axesOf(lit, step)) * display_->resolution.width / (display_->right - display_->left);
    expect(a, b, lit, seam);
  }

  /// Wall units.
  [[nodiscard]] double narrowest(const Site& a, const Site& b, const Axes& axes) const {
    const glm::dvec2 step = (axes.extent.high - axes.extent.low) / double{kStations};
    int fewest = kStations;
    for (int station = kStations / 10; station < kStations - kStations / 10; ++station) {
      int wide = 0;
      for (int i = 0; i < kStations; ++i) {
        const glm::dvec2 at = axes.extent.low + step * glm::dvec2(station + 0.5, i + 0.5);
        const glm::dvec2 point = axes.centre + axes.along * at.x + axes.across * at.y;
        if (shown(point) && a.lights(point) && b.lights(point)) ++wide;
      }
      fewest = std::min(fewest, wide);
    }
    return fewest * step.y;
  }

  static void expect(const Site& a, const Site& b, const std::vector<glm::dvec2>& lit, Seam& seam) {
    constexpr std::size_t kMostPoints = 400;
    const std::size_t stride = std::max<std::size_t>(1, lit.size() / kMostPoints);
    const ProjectorMapping& coarser = a.density < b.density ? a.mapping : b.mapping;
    double seen = 0, unseen = 0, worst = 0;
    int count = 0;
    for (std::size_t i = 0; i < lit.size(); i += stride) {
      const auto atA = a.uncertainty.at(lit[i]);
      const auto atB = b.uncertainty.at(lit[i]);
      const auto p = coarser.projectorFromWall(lit[i]);
      if (!atA || !atB || !p) continue;
      const double perUnit = std::pow(coarser.density(*p), 2);
      const glm::dvec2 apart = atA->meanResidual - atB->meanResidual;
      const double bent = perUnit * glm::dot(apart, apart);
      const double noise = perUnit * (atA->meanVariance + atB->meanVariance);
      const double variance = perUnit * (atA->modelVariance + atB->modelVariance);
      const double surely = std::max(0.0, bent - kBound95 * kBound95 * noise);
      seen += bent - noise, unseen += variance, ++count;
      worst = std::max(worst, surely + kBound95 * kBound95 * variance);
    }
    if (count == 0) return;
    seam.expectedRms = std::sqrt((std::max(0.0, seen) + unseen) / count);
    seam.expectedWorst = std::max(std::sqrt(worst), seam.expectedRms);
  }

  std::optional<Display> display_;
  std::vector<Site> sites_;
};

}  // namespace

std::vector<Seam> findSeams(const Calibration& calibration) {
  return SeamFinder(calibration).find();
}

}  // namespace pixelflex::calib
