#include "viewer/renderer/dither_tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

namespace pixelflex::viewer {
namespace {

constexpr int kExtent = kDitherExtent;
constexpr std::size_t kCells = std::size_t{kExtent} * kExtent;

std::size_t cellAt(int x, int y) {
  const auto wrap = [](int v) { return static_cast<std::size_t>((v + kExtent) % kExtent); };
  return wrap(y) * kExtent + wrap(x);
}

/// Points on a torus and how crowded each cell is: the void-and-cluster method (Ulichney 1993).
class Points {
 public:
  Points() {
    constexpr double kSigma = 1.5;
    for (int i = 0; i <= kReach; ++i) {
      weights_[static_cast<std::size_t>(i)] = static_cast<float>(std::exp(-i * i / (2 * kSigma * kSigma)));
    }
  }

  void set(std::size_t cell, bool present) {
    taken_[cell] = present;
    const int x = static_cast<int>(cell % kExtent);
    const int y = static_cast<int>(cell / kExtent);
    for (int dy = -kReach; dy <= kReach; ++dy) {
      const float row = (present ? 1.0F : -1.0F) * weightAt(dy);
      for (int dx = -kReach; dx <= kReach; ++dx) {
        crowd_[cellAt(x + dx, y + dy)] += row * weightAt(dx);
      }
    }
  }

  [[nodiscard]] bool taken(std::size_t cell) const { return taken_[cell]; }

  /// The point with most points around it.
  [[nodiscard]] std::size_t tightest() const {
    return bestOf(true, [](float a, float b) { return a > b; });
  }
  /// The free cell with fewest.
  [[nodiscard]] std::size_t emptiest() const {
    return bestOf(false, [](float a, float b) { return a < b; });
  }

 private:
  static constexpr int kReach = 9;

  [[nodiscard]] float weightAt(int distance) const { return weights_[static_cast<std::size_t>(std::abs(distance))]; }

  template <class Better>
  [[nodiscard]] std::size_t bestOf(bool taken, Better better) const {
    std::size_t best = kCells;
    for (std::size_t cell = 0; cell < kCells; ++cell) {
      if (taken_[cell] == taken && (best == kCells || better(crowd_[cell], crowd_[best]))) best = cell;
    }
    return best;
  }

  std::array<float, kReach + 1> weights_{};  // by distance
  std::vector<bool> taken_ = std::vector<bool>(kCells, false);
  std::vector<float> crowd_ = std::vector<float>(kCells, 0.0F);
};

/// A tenth of the cells, moved from the tightest cluster to the largest void until that changes nothing.
Points evenPoints() {
  Points points;
  std::minstd_rand random(1);
  for (std::size_t count = 0; count < kCells / 10;) {
    const auto cell = static_cast<std::size_t>(random()) % kCells;
    if (points.taken(cell)) continue;
    points.set(cell, true);
    ++count;
  }
  for (std::size_t moves = 0; moves < kCells; ++moves) {
    const auto from = points.tightest();
    points.set(from, false);
    const auto to = points.emptiest();
    points.set(to, true);
    if (from == to) break;
  }
  return points;
}

/// For each cell when it is filled, 0 to kCells - 1: at any time the filled ones are spread evenly.
std::vector<std::size_t> ranks() {
  std::vector<std::size_t> rank(kCells);
  const Points start = evenPoints();
  Points thinned = start;
  for (std::size_t next = kCells / 10; next > 0; --next) {
    const auto cell = thinned.tightest();
    thinned.set(cell, false);
    rank[cell] = next - 1;
  }
  Points filled = start;
  for (std::size_t next = kCells / 10; next < kCells; ++next) {
    const auto cell = filled.emptiest();
    filled.set(cell, true);
    rank[cell] = next;
  }
  return rank;
}

devices::Image8 made() {
  const auto rank = ranks();
  // The same noise at places far from one another.
  constexpr std::array<std::array<int, 2>, 3> kShifts{{{0, 0}, {23, 41}, {45, 19}}};
  devices::Image8 tile({kExtent, kExtent}, 3);
  for (int y = 0; y < kExtent; ++y) {
    for (int x = 0; x < kExtent; ++x) {
      for (int c = 0; c < 3; ++c) {
        const auto& shift = kShifts[static_cast<std::size_t>(c)];
        const auto place = rank[cellAt((x + shift[0]) % kExtent, (y + shift[1]) % kExtent)];
        tile.at(x, y, c) = static_cast<std::uint8_t>(place * 256 / kCells);
      }
    }
  }
  return tile;
}

}  // namespace

devices::Image8 makeDitherTile() {
  static const devices::Image8 tile = made();
  return tile;
}

}  // namespace pixelflex::viewer
