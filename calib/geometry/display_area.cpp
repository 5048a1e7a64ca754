#include "calib/geometry/display_area.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace pixelflex::calib {
namespace {

struct Bounds {
  glm::dvec2 low{std::numeric_limits<double>::max()};
  glm::dvec2 high{std::numeric_limits<double>::lowest()};
};

Bounds boundsOf(std::span<const Outline> footprints) {
  Bounds bounds;
  for (const auto& outline : footprints) {
    for (const auto& point : outline) {
      bounds.low = {std::min(bounds.low.x, point.x), std::min(bounds.low.y, point.y)};
      bounds.high = {std::max(bounds.high.x, point.x), std::max(bounds.high.y, point.y)};
    }
  }
  return bounds;
}

/// The x positions, sorted, where a horizontal line crosses the outline; inside is between each pair. A line along the
/// outline's top or bottom counts as inside.
std::vector<double> crossings(const Outline& outline, double y) {
  const auto [top, bottom] = std::ranges::minmax(outline, {}, &glm::dvec2::y);
  const double hair = 1e-9 * (bottom.y - top.y);
  if (y < top.y - hair || y > bottom.y + hair) return {};
  y = std::clamp(y, top.y + hair, bottom.y - hair);
  std::vector<double> xs;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 a = outline[i];
    const glm::dvec2 b = outline[(i + 1) % outline.size()];
    if ((a.y <= y) != (b.y <= y)) xs.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
  }
  std::ranges::sort(xs);
  return xs;
}

/// Turns a row or column of flags into: is every flag within `margin` set? Outside counts as not set.
void erodeLine(unsigned char* line, std::size_t count, std::size_t stride, int margin) {
  int lastClear = -1;
  std::vector<int> clearBefore(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (line[i * stride] == 0) lastClear = static_cast<int>(i);
    clearBefore[i] = lastClear;
  }
  int nextClear = static_cast<int>(count);
  for (std::size_t k = count; k-- > 0;) {
    const int i = static_cast<int>(k);
    if (line[k * stride] == 0) nextClear = i;
    if (i - clearBefore[k] <= margin || nextClear - i <= margin) line[k * stride] = 0;
  }
}

double centrality(const CellRect& rect, const Coverage& coverage) {
  const double dx = 0.5 * (rect.left + rect.right) - 0.5 * coverage.width();
  const double dy = 0.5 * (rect.top + rect.bottom) - 0.5 * coverage.height();
  return -(dx * dx + dy * dy);
}

void keepBetter(std::optional<CellRect>& best, const CellRect& candidate, const Coverage& coverage) {
  if (candidate.area() <= 0) return;
  if (!best || candidate.area() > best->area() ||
      (candidate.area() == best->area() && centrality(candidate, coverage) > centrality(*best, coverage))) {
    best = candidate;
  }
}

/// Of all rectangles that end on this row, given how many covered cells stand above each column.
void scanHistogram(const std::vector<int>& heights, int row, const Coverage& coverage, std::optional<CellRect>& best) {
  std::vector<std::pair<int, int>> open;  // (first column, height), heights rising
  for (int x = 0; x <= static_cast<int>(heights.size()); ++x) {
    const int height = x < static_cast<int>(heights.size()) ? heights[static_cast<std::size_t>(x)] : 0;
    int start = x;
    while (!open.empty() && open.back().second > height) {
      const auto [left, tall] = open.back();
      open.pop_back();
      keepBetter(best, {left, row + 1 - tall, x, row + 1}, coverage);
      start = left;
    }
    if (height > 0 && (open.empty() || open.back().second < height)) open.emplace_back(start, height);
  }
}

/// Number of covered cells above and left of each lattice corner.
class SummedArea {
 public:
  explicit SummedArea(const Coverage& coverage) : stride_(static_cast<std::size_t>(coverage.width()) + 1) {
    sums_.resize(stride_ * (static_cast<std::size_t>(coverage.height()) + 1));
    for (int y = 0; y < coverage.height(); ++y) {
      std::int32_t row = 0;
      for (int x = 0; x < coverage.width(); ++x) {
        row += coverage.covered(x, y) ? 1 : 0;
        at(x + 1, y + 1) = row + at(x + 1, y);
      }
    }
  }
  [[nodiscard]] bool full(const CellRect& r) {
    return at(r.right, r.bottom) - at(r.left, r.bottom) - at(r.right, r.top) + at(r.left, r.top) == r.area();
  }

 private:
  std::int32_t& at(int x, int y) { return sums_[static_cast<std::size_t>(y) * stride_ + static_cast<std::size_t>(x)]; }
  std::size_t stride_;
  std::vector<std::int32_t> sums_;
};

/// The most central full rectangle of this size.
std::optional<CellRect> findOfSize(const Coverage& coverage, SummedArea& sums, int width, int height) {
  std::optional<CellRect> best;
  for (int y = 0; y + height <= coverage.height(); ++y) {
    for (int x = 0; x + width <= coverage.width(); ++x) {
      const CellRect candidate{x, y, x + width, y + height};
      if (sums.full(candidate)) keepBetter(best, candidate, coverage);
    }
  }
  return best;
}

double desktopDensity(std::span<const double> densities, const DesktopRequest& request) {
  double density = request.pixelsPerUnit;
  if (request.density == DensityRule::kMax) density = *std::ranges::max_element(densities);
  if (request.density == DensityRule::kMean) {
    density = std::accumulate(densities.begin(), densities.end(), 0.0) / static_cast<double>(densities.size());
  }
  return density / request.oversampling;
}

}  // namespace

Coverage::Coverage(std::span<const Outline> footprints, double pixelsPerUnit) : pixelsPerUnit_(pixelsPerUnit) {
  if (footprints.empty()) throw GeometryError("no projector lights the wall");
  const Bounds bounds = boundsOf(footprints);
  const glm::dvec2 cells = (bounds.high - bounds.low) * pixelsPerUnit;
  if (!(cells.x >= 1 && cells.y >= 1)) throw GeometryError("the lit area is smaller than a desktop pixel");
  if (!(cells.x * cells.y <= double(1 << 29))) {
    throw GeometryError("the lit area would need a desktop of over 2^29 pixels; lower desktop: density in wall.yaml");
  }
  origin_ = bounds.low;
  width_ = static_cast<int>(cells.x);
  height_ = static_cast<int>(cells.y);
  cells_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (const auto& outline : footprints) addFootprint(outline);
}

void Coverage::addFootprint(const Outline& outline) {
  constexpr double kHair = 1e-6;  // cells: a corner on the outline is inside, whatever the rounding
  std::vector<double> above;
  for (int y = 0; y <= height_; ++y) {
    auto below = crossings(outline, origin_.y + y / pixelsPerUnit_);
    for (std::size_t i = 0; i + 1 < std::min(above.size(), below.size()); i += 2) {
      const double left = std::max(above[i], below[i]);
      const double right = std::min(above[i + 1], below[i + 1]);
      const int from = std::max(0, static_cast<int>(std::ceil((left - origin_.x) * pixelsPerUnit_ - kHair)));
      const int to = std::min(width_, static_cast<int>(std::floor((right - origin_.x) * pixelsPerUnit_ + kHair)));
      for (int x = from; x < to; ++x) cells_[index(x, y - 1)] = 1;
    }
    above = std::move(below);
  }
}

void Coverage::erode(int margin) {
  if (margin <= 0) return;
  const auto width = static_cast<std::size_t>(width_);
  const auto height = static_cast<std::size_t>(height_);
  for (std::size_t y = 0; y < height; ++y) erodeLine(&cells_[y * width], width, 1, margin);
  for (std::size_t x = 0; x < width; ++x) erodeLine(&cells_[x], height, width, margin);
}

std::optional<CellRect> largestRectangle(const Coverage& coverage) {
  std::optional<CellRect> best;
  std::vector<int> heights(static_cast<std::size_t>(coverage.width()), 0);
  for (int y = 0; y < coverage.height(); ++y) {
    for (int x = 0; x < coverage.width(); ++x) {
      auto& height = heights[static_cast<std::size_t>(x)];
      height = coverage.covered(x, y) ? height + 1 : 0;
    }
    scanHistogram(heights, y, coverage, best);
  }
  return best;
}

std::optional<CellRect> largestRectangle(const Coverage& coverage, AspectRatio aspect) {
  SummedArea sums(coverage);
  const double ratio = aspect.width / aspect.height;
  std::optional<CellRect> best;
  int fits = 0;
  int tooHigh = coverage.height() + 1;
  while (tooHigh - fits > 1) {
    const int height = (fits + tooHigh) / 2;
    const int width = std::max(1, static_cast<int>(std::lround(height * ratio)));
    const auto found = findOfSize(coverage, sums, width, height);
    (found ? fits : tooHigh) = height;
    if (found) best = found;
  }
  return best;
}

bool isLit(const Display& display, std::span<const Outline> footprints) {
  const Outline rectangle = {{display.left, display.top},
                             {display.right, display.top},
                             {display.right, display.bottom},
                             {display.left, display.bottom}};
  std::vector<Outline> withDisplay(footprints.begin(), footprints.end());
  const double lit = uniteFootprints(withDisplay).area;
  withDisplay.push_back(rectangle);
  const double pixel = areaOf(rectangle) / static_cast<double>(display.resolution.area());
  return uniteFootprints(withDisplay).area - lit < 1e-3 * pixel;
}

Display findDisplay(std::span<const Outline> footprints, std::span<const double> densities,
                    const DisplayRequest& request, const DesktopRequest& desktop) {
  if (footprints.empty()) throw GeometryError("no projector lights the wall");
  const Bounds bounds = boundsOf(footprints);
  const glm::dvec2 extent = bounds.high - bounds.low;
  const double density =
      std::min(desktopDensity(densities, desktop), kLargestDesktopExtent / std::max(extent.x, extent.y));
  Coverage coverage(footprints, density);
  coverage.erode(request.margin);
  const auto rect = request.aspect ? largestRectangle(coverage, *request.aspect) : largestRectangle(coverage);
  if (!rect) {
    throw GeometryError("no rectangle is left inside the lit area after a margin of " + std::to_string(request.margin) +
                        " desktop pixels; lower display: margin in wall.yaml or light more of the wall");
  }
  const glm::dvec2 topLeft = coverage.wallFromCell({rect->left, rect->top});
  const glm::dvec2 bottomRight = coverage.wallFromCell({rect->right, rect->bottom});
  return {topLeft.x, topLeft.y, bottomRight.x, bottomRight.y, {rect->right - rect->left, rect->bottom - rect->top}};
}

}  // namespace pixelflex::calib
