#pragma once

#include <vector>

namespace pixelflex::calib {

/// Columns of one lattice row, half-open, never empty.
struct Span {
  int from = 0, to = 0;
  bool operator==(const Span&) const = default;
};

/// The columns that hold something, from left to right; no two spans touch.
using RowSpans = std::vector<Span>;

/// The columns in either.
[[nodiscard]] RowSpans unite(const RowSpans& a, const RowSpans& b);

/// The columns in both.
[[nodiscard]] RowSpans intersect(const RowSpans& a, const RowSpans& b);

/// The columns that keep `margin` columns of their own on both sides.
[[nodiscard]] RowSpans shrink(const RowSpans& row, int margin);

/// Every row becomes what it has in common with the `count - 1` rows below it; past the last row there is nothing.
void intersectWithRowsBelow(std::vector<RowSpans>& rows, int count);

}  // namespace pixelflex::calib
