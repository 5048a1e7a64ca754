#include "calib/geometry/display_area.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace pixelflex::calib {
namespace {

/// Columns of a row from where on upwards they are covered: all of them from row `top` to this one.
struct Stretch {
  int from = 0, to = 0;
  int top = 0;
};

void append(std::vector<Stretch>& stretches, const Stretch& next) {
  if (next.from >= next.to) return;
  const bool goesOn = !stretches.empty() && stretches.back().to == next.from && stretches.back().top == next.top;
  if (goesOn) {
    stretches.back().to = next.to;
  } else {
    stretches.push_back(next);
  }
}

/// From the stretches of the row above to those of row `y`.
std::vector<Stretch> descend(const std::vector<Stretch>& above, const RowSpans& row, int y) {
  std::vector<Stretch> stretches;
  auto next = above.begin();
  for (const Span& span : row) {
    int x = span.from;
    while (next != above.end() && next->to <= x) ++next;
    for (auto old = next; old != above.end() && old->from < span.to; ++old) {
      append(stretches, {x, old->from, y});
      append(stretches, {std::max(x, old->from), std::min(old->to, span.to), old->top});
      x = std::min(old->to, span.to);
    }
    append(stretches, {x, span.to, y});
  }
  return stretches;
}

/// Calls `visit` with every rectangle that ends on row `y` and can grow neither up nor sideways.
template <class Visit>
void visitMaximal(const std::vector<Stretch>& stretches, int y, const Visit& visit) {
  struct Open {
    int left, top;
  };
  std::vector<Open> open;  // tops rising up the wall from left to right
  const auto close = [&](int top, int right) {
    int left = right;
    for (; !open.empty() && open.back().top < top; open.pop_back()) {
      left = open.back().left;
      visit(CellRect{left, open.back().top, right, y + 1});
    }
    return left;
  };
  int end = 0;
  for (const Stretch& stretch : stretches) {
    if (stretch.from > end) close(y + 1, end);
    const int left = close(stretch.top, stretch.from);
    if (open.empty() || open.back().top > stretch.top) open.push_back({left, stretch.top});
    end = stretch.to;
  }
  close(y + 1, end);
}

/// Calls `visit` with every covered rectangle that cannot grow (and others).
template <class Visit>
void visitMaximal(const Coverage& coverage, const Visit& visit) {
  std::vector<Stretch> stretches;
  for (int y = 0; y < coverage.height(); ++y) {
    stretches = descend(stretches, coverage.row(y), y);
    visitMaximal(stretches, y, visit);
  }
}

double centrality(const CellRect& rect, const Coverage& coverage) {
  const double dx = 0.5 * (rect.left + rect.right) - 0.5 * coverage.width();
  const double dy = 0.5 * (rect.top + rect.bottom) - 0.5 * coverage.height();
  return -(dx * dx + dy * dy);
}

void keepBetter(std::optional<CellRect>& best, const CellRect& candidate, const Coverage& coverage) {
  if (!best || candidate.area() > best->area() ||
      (candidate.area() == best->area() && centrality(candidate, coverage) > centrality(*best, coverage))) {
    best = candidate;
  }
}

int widthOf(int height, double ratio) {
  return std::max(1, static_cast<int>(std::lround(height * ratio)));
}

/// The largest rectangle of this ratio inside another, as near to the lattice's middle as it can be.
std::optional<CellRect> largestInside(const CellRect& room, double ratio, const Coverage& coverage) {
  const int across = room.right - room.left;
  int height = static_cast<int>(std::min<double>(room.bottom - room.top, std::floor((across + 0.5) / ratio) + 1));
  while (height > 0 && widthOf(height, ratio) > across) --height;
  if (height == 0) return std::nullopt;
  const int width = widthOf(height, ratio);
  const int left = std::clamp((coverage.width() - width) / 2, room.left, room.right - width);
  const int top = std::clamp((coverage.height() - height) / 2, room.top, room.bottom - height);
  return CellRect{left, top, left + width, top + height};
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

std::optional<CellRect> largestRectangle(const Coverage& coverage) {
  std::optional<CellRect> best;
  visitMaximal(coverage, [&](const CellRect& found) { keepBetter(best, found, coverage); });
  return best;
}

std::optional<CellRect> largestRectangle(const Coverage& coverage, AspectRatio aspect) {
  const double ratio = aspect.width / aspect.height;
  std::optional<CellRect> best;
  visitMaximal(coverage, [&](const CellRect& room) {
    if (best && room.area() < best->area()) return;
    if (const auto found = largestInside(room, ratio, coverage)) keepBetter(best, *found, coverage);
  });
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
