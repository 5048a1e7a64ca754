#pragma once

#include <glm/vec2.hpp>
#include <limits>
#include <span>
#include <vector>

#include "calib/geometry/footprint.h"
#include "calib/geometry/row_spans.h"

namespace pixelflex::calib {

/// The smallest upright rectangle around some outlines, wall units.
struct Bounds {
  glm::dvec2 low{std::numeric_limits<double>::max()};
  glm::dvec2 high{std::numeric_limits<double>::lowest()};
};
[[nodiscard]] Bounds boundsOf(std::span<const Outline> footprints);

/// Which desktop pixels are wholly lit: a lattice of square cells laid over the wall, each row kept as its spans of
/// covered cells.
class Coverage {
 public:
  /// A lattice over the footprints' bounding box with `pixelsPerUnit` cells per wall unit. A cell counts when one
  /// footprint holds its four corners: no notch between two footprints can hide in it. Throws GeometryError when the
  /// lattice would exceed 2^29 cells.
  Coverage(std::span<const Outline> footprints, double pixelsPerUnit);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return static_cast<int>(rows_.size()); }
  [[nodiscard]] bool covered(int x, int y) const;
  [[nodiscard]] const RowSpans& row(int y) const { return rows_[static_cast<std::size_t>(y)]; }
  [[nodiscard]] glm::dvec2 wallFromCell(glm::dvec2 cell) const { return origin_ + cell / pixelsPerUnit_; }

  /// Uncovers every cell with an uncovered one (or the lattice's outside) within `margin` cells along x or y.
  void erode(int margin);

 private:
  void addFootprint(const Outline& outline);
  int width_ = 0;
  glm::dvec2 origin_{0, 0};
  double pixelsPerUnit_ = 1;
  std::vector<RowSpans> rows_;
};

}  // namespace pixelflex::calib
