#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "calib/geometry/coverage.h"
#include "calib/geometry/footprint.h"
#include "calib/store/calibration.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// A rectangle of cells, half-open.
struct CellRect {
  int left = 0, top = 0, right = 0, bottom = 0;
  [[nodiscard]] std::int64_t area() const { return std::int64_t{right - left} * (bottom - top); }
  bool operator==(const CellRect&) const = default;
};

/// The largest rectangle of covered cells, exact on the lattice: the histogram method over spans instead of cells,
/// O(height * spans), O(width * height) at worst. Of equal ones the most central. None when nothing is covered.
[[nodiscard]] std::optional<CellRect> largestRectangle(const Coverage& coverage);

/// The largest covered rectangle whose sides have this ratio, its width rounded to a cell; exact on the lattice, in the
/// same time. Of equal ones the most central.
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
