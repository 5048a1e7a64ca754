#include "calib/geometry/coverage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace pixelflex::calib {
namespace {

/// Where each horizontal line y = 0, 1, ... `height` crosses the outline, from left to right; inside is between each
/// pair. A line along the outline's top or bottom counts as inside.
std::vector<std::vector<double>> crossings(const Outline& outline, int height) {
  std::vector<std::vector<double>> lines(static_cast<std::size_t>(height) + 1);
  const auto [top, bottom] = std::ranges::minmax(outline, {}, &glm::dvec2::y);
  const double hair = 1e-9 * (bottom.y - top.y);
  const int first = std::max(0, static_cast<int>(std::ceil(top.y - hair)));
  const int last = std::min(height, static_cast<int>(std::floor(bottom.y + hair)));
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 a = outline[i];
    const glm::dvec2 b = outline[(i + 1) % outline.size()];
    const auto [low, high] = std::minmax(a.y, b.y);
    const int end = std::min(last, static_cast<int>(std::ceil(high)));
    for (int line = std::max(first, static_cast<int>(std::floor(low))); line <= end; ++line) {
      const double y = std::clamp(double(line), top.y + hair, bottom.y - hair);
      if (low > y || high <= y) continue;
      lines[static_cast<std::size_t>(line)].push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
  }
  for (auto& xs : lines) std::ranges::sort(xs);
  return lines;
}

/// The whole cells between each pair of crossings.
RowSpans wholeCells(const std::vector<double>& xs, int width) {
  constexpr double kHair = 1e-6;  // cells: a corner on the outline is inside, whatever the rounding
  RowSpans cells;
  for (std::size_t i = 0; i + 1 < xs.size(); i += 2) {
    const int from = std::max(0, static_cast<int>(std::ceil(xs[i] - kHair)));
    const int to = std::min(width, static_cast<int>(std::floor(xs[i + 1] + kHair)));
    if (from < to) cells.push_back({from, to});
  }
  return cells;
}

}  // namespace

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
  rows_.resize(static_cast<std::size_t>(cells.y));
  for (const auto& outline : footprints) addFootprint(outline);
}

bool Coverage::covered(int x, int y) const {
  return std::ranges::any_of(row(y), [x](const Span& span) { return x >= span.from && x < span.to; });
}

void Coverage::addFootprint(const Outline& outline) {
  Outline inCells;
  for (const auto& point : outline) inCells.push_back((point - origin_) * pixelsPerUnit_);
  const auto lines = crossings(inCells, height());
  RowSpans above = wholeCells(lines[0], width_);
  for (std::size_t y = 0; y < rows_.size(); ++y) {
    RowSpans below = wholeCells(lines[y + 1], width_);
    rows_[y] = unite(rows_[y], intersect(above, below));
    above = std::move(below);
  }
}

void Coverage::erode(int margin) {
  if (margin <= 0) return;
  margin = std::min(margin, std::max(width_, height()));
  for (auto& row : rows_) row = shrink(row, margin);
  intersectWithRowsBelow(rows_, 2 * margin + 1);
  // A row stands for itself and those below it by now: it moves down to where it is the middle one.
  const auto keptRows = static_cast<std::ptrdiff_t>(std::max(0, height() - margin));
  std::shift_right(rows_.begin(), rows_.end(), margin);
  std::fill(rows_.begin(), rows_.end() - keptRows, RowSpans{});
}

}  // namespace pixelflex::calib
