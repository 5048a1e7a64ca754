#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "calib/geometry/footprint.h"
#include "calib/store/calibration.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// Which desktop pixels are wholly lit: a lattice of square cells laid over the wall.
class Coverage {
 public:
  /// A lattice over the footprints' bounding box with `pixelsPerUnit` cells per wall unit. A cell counts when one
  /// footprint holds its four corners: no notch between two footprints can hide in it. Throws GeometryError when the
  /// lattice would exceed 2^29 cells.
  Coverage(std::span<const Outline> footprints, double pixelsPerUnit);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool covered(int x, int y) const { return cells_[index(x, y)] != 0; }
  [[nodiscard]] glm::dvec2 wallFromCell(glm::dvec2 cell) const { return origin_ + cell / pixelsPerUnit_; }

  /// Uncovers every cell with an uncovered one (or the lattice's outside) within `margin` cells along x or y.
  void erode(int margin);

 private:
  void addFootprint(const Outline& outline);
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_ = 0;
  int height_ = 0;
  glm::dvec2 origin_{0, 0};
  double pixelsPerUnit_ = 1;
  std::vector<unsigned char> cells_;
};

/// A rectangle of cells, half-open.
struct CellRect {
  int left = 0, top = 0, right = 0, bottom = 0;
  [[nodiscard]] std::int64_t area() const { return std::int64_t{right - left} * (bottom - top); }
  bool operator==(const CellRect&) const = default;
};

/// The largest rectangle of covered cells, exact on the lattice: the histogram method, O(width * height). Of equal ones
/// the most central. None when nothing is covered.
[[nodiscard]] std::optional<CellRect> largestRectangle(const Coverage& coverage);

/// The largest covered rectangle whose sides have this ratio, to the nearest cell: bisection over its height with a
/// summed-area table.
[[nodiscard]] std::optional<CellRect> largestRectangle(const Coverage& coverage, AspectRatio aspect);

/// The effective display area (report 5.1.4) and the resolution of the desktop that fills it.
/// `densities`: projector pixels per wall unit, one per footprint. Throws GeometryError when nothing is left.
[[nodiscard]] Display findDisplay(std::span<const Outline> footprints, std::span<const double> densities,
                                  const DisplayRequest& request, const DesktopRequest& desktop);

/// Whether every point of a display is lit, up to a thousandth of a desktop pixel's area in all.
[[nodiscard]] bool isLit(const Display& display, std::span<const Outline> footprints);

/// No desktop is wider or higher: what X servers over VNC can hold.
inline constexpr int kLargestDesktopExtent = 16384;

}  // namespace pixelflex::calib
