#include "viewer/tiles/region.h"

#include <cassert>
#include <cstdint>
#include <limits>
#include <utility>

namespace pixelflex::viewer {
namespace {

bool overlap(const Box& a, const Box& b) {
  return !intersect(a, b).empty();
}

// How many pixels the smallest box around both holds that neither of the two disjoint boxes does.
std::int64_t waste(const Box& a, const Box& b) {
  return enclose(a, b).area() - a.area() - b.area();
}

// `box` without `hole`, which overlaps it, as at most four disjoint boxes.
void pushDifference(const Box& box, const Box& hole, std::vector<Box>& out) {
  const Box inner = intersect(box, hole);
  const Box pieces[] = {{box.left, box.top, box.right, inner.top},
                        {box.left, inner.top, inner.left, inner.bottom},
                        {inner.right, inner.top, box.right, inner.bottom},
                        {box.left, inner.bottom, box.right, box.bottom}};
  for (const Box& piece : pieces) {
    if (!piece.empty()) out.push_back(piece);
  }
}

// Puts in a box that overlaps none of `boxes`. Neighbours that together form a box become one: a server cuts a large
// change into many strips, and here they grow together again.
void insertDisjoint(Box box, std::vector<Box>& boxes) {
  for (std::size_t i = 0; i < boxes.size();) {
    if (waste(box, boxes[i]) != 0) {
      ++i;
      continue;
    }
    box = enclose(box, boxes[i]);
    boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(i));
    i = 0;
  }
  boxes.push_back(box);
}

std::pair<std::size_t, std::size_t> cheapestPair(const std::vector<Box>& boxes) {
  std::pair<std::size_t, std::size_t> best{0, 1};
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size(); ++j) {
      const std::int64_t cost = waste(boxes[i], boxes[j]);
      if (cost < least) {
        least = cost;
        best = {i, j};
      }
    }
  }
  return best;
}

// Removes every box that overlaps `grown` and grows it around them, until it overlaps none.
void absorb(Box grown, std::vector<Box>& boxes) {
  for (std::size_t i = 0; i < boxes.size();) {
    if (!overlap(grown, boxes[i])) {
      ++i;
      continue;
    }
    grown = enclose(grown, boxes[i]);
    boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(i));
    i = 0;
  }
  insertDisjoint(grown, boxes);
}

void mergeCheapestPair(std::vector<Box>& boxes) {
  const auto [first, second] = cheapestPair(boxes);
  const Box merged = enclose(boxes[first], boxes[second]);
  boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(second));
  boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(first));
  absorb(merged, boxes);
}

}  // namespace

void Region::add(const Box& box) {
  if (box.empty()) return;
  std::erase_if(boxes_, [&box](const Box& old) { return box.contains(old); });
  std::vector<Box> pending{box};
  while (!pending.empty()) {
    const Box piece = pending.back();
    pending.pop_back();
    const auto hit = std::find_if(boxes_.begin(), boxes_.end(), [&](const Box& old) { return overlap(piece, old); });
    if (hit != boxes_.end()) {
      pushDifference(piece, *hit, pending);
      continue;
    }
    insertDisjoint(piece, boxes_);
    if (boxes_.size() > kMaxBoxes) mergeCheapestPair(boxes_);
  }
  assert(boxes_.size() <= kMaxBoxes);
}

std::int64_t Region::area() const {
  std::int64_t sum = 0;
  for (const Box& box : boxes_) sum += box.area();
  return sum;
}

}  // namespace pixelflex::viewer
