#pragma once

#include <algorithm>
#include <cstdint>

#include "devices/image/size.h"

namespace pixelflex::viewer {

/// A half-open box of pixels: [left, right) x [top, bottom). Empty unless left < right and top < bottom.
struct Box {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;

  [[nodiscard]] bool empty() const { return left >= right || top >= bottom; }
  [[nodiscard]] int width() const { return empty() ? 0 : right - left; }
  [[nodiscard]] int height() const { return empty() ? 0 : bottom - top; }
  [[nodiscard]] std::int64_t area() const { return std::int64_t{width()} * height(); }
  [[nodiscard]] bool contains(const Box& other) const {
    return other.empty() || (left <= other.left && top <= other.top && right >= other.right && bottom >= other.bottom);
  }
  bool operator==(const Box&) const = default;
};

[[nodiscard]] inline Box boxOf(devices::Size size) {
  return {0, 0, size.width, size.height};
}

[[nodiscard]] inline Box intersect(const Box& a, const Box& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

/// The smallest box around both; an empty box adds nothing.
[[nodiscard]] inline Box enclose(const Box& a, const Box& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}

}  // namespace pixelflex::viewer
