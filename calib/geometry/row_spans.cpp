#include "calib/geometry/row_spans.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace pixelflex::calib {

RowSpans unite(const RowSpans& a, const RowSpans& b) {
  RowSpans sorted;
  std::ranges::merge(a, b, std::back_inserter(sorted), {}, &Span::from, &Span::from);
  RowSpans united;
  for (const Span& span : sorted) {
    if (united.empty() || span.from > united.back().to) {
      united.push_back(span);
    } else {
      united.back().to = std::max(united.back().to, span.to);
    }
  }
  return united;
}

RowSpans intersect(const RowSpans& a, const RowSpans& b) {
  RowSpans both;
  auto left = a.begin();
  auto right = b.begin();
  while (left != a.end() && right != b.end()) {
    const Span common{std::max(left->from, right->from), std::min(left->to, right->to)};
    if (common.from < common.to) both.push_back(common);
    if (left->to < right->to) {
      ++left;
    } else {
      ++right;
    }
  }
  return both;
}

RowSpans shrink(const RowSpans& row, int margin) {
  RowSpans kept;
  for (const Span& span : row) {
    if (span.to - span.from > 2 * margin) kept.push_back({span.from + margin, span.to - margin});
  }
  return kept;
}

void intersectWithRowsBelow(std::vector<RowSpans>& rows, int count) {
  const std::size_t height = rows.size();
  const auto wanted = static_cast<std::size_t>(std::max(count, 1));
  // Each pass doubles the number of rows that a row stands for, or brings it to `count`.
  for (std::size_t done = 1; done < std::min(wanted, height + 1);) {
    const std::size_t step = std::min(done, wanted - done);
    for (std::size_t y = 0; y < height; ++y) {
      if (y + step < height) {
        rows[y] = intersect(rows[y], rows[y + step]);
      } else {
        rows[y].clear();
      }
    }
    done += step;
  }
}

}  // namespace pixelflex::calib
