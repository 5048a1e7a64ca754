#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "viewer/tiles/box.h"

namespace pixelflex::viewer {

/// Damage: a set of disjoint boxes, at most kMaxBoxes; when there would be more, the pair whose union wastes the fewest
/// pixels is merged. Covers at least every pixel added.
class Region {
 public:
  static constexpr std::size_t kMaxBoxes = 64;

  void add(const Box& box);
  void clear() { boxes_.clear(); }
  [[nodiscard]] bool empty() const { return boxes_.empty(); }
  [[nodiscard]] std::span<const Box> boxes() const { return boxes_; }
  [[nodiscard]] std::int64_t area() const;

 private:
  std::vector<Box> boxes_;
};

}  // namespace pixelflex::viewer
