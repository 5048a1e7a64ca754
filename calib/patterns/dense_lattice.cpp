#include "calib/patterns/dense_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <thread>

namespace pixelflex::calib {
namespace {

constexpr double kWindow = 12;     // camera pixels on each side of a point that carry its fit, at least
constexpr double kMostJump = 0.3;  // of the step between neighbours

/// Decoded pixels sorted into the cells between lattice points; the first and last cells reach to the frame's border.
class Cells {
 public:
  Cells(const DensePixels& pixels, const DenseLayout& layout, const CameraMapping& camera)
      : columns_(layout.columns() + 1), rows_(layout.rows() + 1) {
    cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (int y = 0; y < pixels.points.height(); ++y) {
      for (int x = 0; x < pixels.points.width(); ++x) {
        if (!pixels.known(x, y)) continue;
        const glm::dvec2 point(pixels.points.at(x, y, 0), pixels.points.at(x, y, 1));
        const glm::dvec2 at = (point - layout.margin()) / layout.step() + 1.0;
        cell(std::clamp(static_cast<int>(at.x), 0, columns_ - 1), std::clamp(static_cast<int>(at.y), 0, rows_ - 1))
            .push_back({point, camera.undistortedFromRaw({x + 0.5, y + 0.5})});
      }
    }
  }

  /// The pixels of the `reach` cells on each side of a lattice point.
  [[nodiscard]] std::vector<DensePair> around(int column, int row, int reachColumns, int reachRows) const {
    std::vector<DensePair> pairs;
    for (int r = std::max(0, row + 1 - reachRows); r <= std::min(rows_ - 1, row + reachRows); ++r) {
      for (int c = std::max(0, column + 1 - reachColumns); c <= std::min(columns_ - 1, column + reachColumns); ++c) {
        const auto& some = cells_[index(c, r)];
        pairs.insert(pairs.end(), some.begin(), some.end());
      }
    }
    return pairs;
  }

 private:
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  std::vector<DensePair>& cell(int column, int row) { return cells_[index(column, row)]; }

  int columns_;
  int rows_;
  std::vector<std::vector<DensePair>> cells_;
};

std::size_t indexOf(const DenseLayout& layout, int column, int row) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(layout.columns()) + static_cast<std::size_t>(column);
}

/// Whether two points, `step` apart in the projector, lie where each other's maps expect them.
bool continues(const LocalMap& a, const LocalMap& b, glm::dvec2 step) {
  const glm::dvec2 expected = 0.5 * ((a.byX + b.byX) * step.x + (a.byY + b.byY) * step.y);
  const glm::dvec2 seen = b.pointInUndistorted - a.pointInUndistorted;
  return glm::length(seen - expected) <= kMostJump * glm::length(expected);
}

/// Joins neighbouring lattice points that continue each other into parts.
class Parts {
 public:
  Parts(DenseLattice& lattice, const DenseLayout& layout)
      : lattice_(lattice), layout_(layout), part_(lattice.size(), kNone) {}

  void findAll() {
    for (int row = 0; row < layout_.rows(); ++row) {
      for (int column = 0; column < layout_.columns(); ++column) {
        const std::size_t i = indexOf(layout_, column, row);
        if (lattice_[i] && part_[i] == kNone) fill(column, row);
      }
    }
  }
  /// Returns its share.
  double keepLargest() {
    if (sizes_.empty()) return 0;
    const auto largest = std::ranges::max_element(sizes_);
    for (std::size_t i = 0; i < part_.size(); ++i) {
      if (part_[i] != largest - sizes_.begin()) lattice_[i].reset();
    }
    return static_cast<double>(*largest) / std::accumulate(sizes_.begin(), sizes_.end(), 0);
  }

 private:
  static constexpr int kNone = -1;
  struct Place {
    int column, row;
  };

  void fill(int column, int row) {
    const int part = static_cast<int>(sizes_.size());
    sizes_.push_back(0);
    std::vector<Place> open{{column, row}};
    part_[indexOf(layout_, column, row)] = part;
    while (!open.empty()) {
      const Place here = open.back();
      open.pop_back();
      ++sizes_.back();
      for (const Place by : {Place{1, 0}, Place{-1, 0}, Place{0, 1}, Place{0, -1}}) visit(here, by, part, open);
    }
  }

  /// The next known point that way, if it continues this one.
  void visit(Place here, Place by, int part, std::vector<Place>& open) {
    const auto& a = lattice_[indexOf(layout_, here.column, here.row)];
    Place there{here.column + by.column, here.row + by.row};
    while (inside(there) && !lattice_[indexOf(layout_, there.column, there.row)]) {
      there = {there.column + by.column, there.row + by.row};
    }
    if (!inside(there)) return;
    const auto& b = lattice_[indexOf(layout_, there.column, there.row)];
    int& known = part_[indexOf(layout_, there.column, there.row)];
    const glm::dvec2 step = layout_.step() * glm::dvec2(there.column - here.column, there.row - here.row);
    if (known != kNone || !a || !b || !continues(*a, *b, step)) return;
    known = part;
    open.push_back(there);
  }
  [[nodiscard]] bool inside(Place at) const {
    return at.column >= 0 && at.row >= 0 && at.column < layout_.columns() && at.row < layout_.rows();
  }

  DenseLattice& lattice_;
  const DenseLayout& layout_;
  std::vector<int> part_;
  std::vector<int> sizes_;
};

}  // namespace

DenseLattice fitLattice(const DensePixels& pixels, double cameraScale, const DenseLayout& layout,
                        const CameraMapping& camera) {
  const Cells cells(pixels, layout, camera);
  const double window = kWindow / cameraScale;
  const int reachColumns = std::max(1, static_cast<int>(std::ceil(window / layout.step().x)));
  const int reachRows = std::max(1, static_cast<int>(std::ceil(window / layout.step().y)));
  const double reach = std::max(reachColumns * layout.step().x, reachRows * layout.step().y);
  DenseLattice lattice;
  lattice.resize(static_cast<std::size_t>(layout.columns()) * static_cast<std::size_t>(layout.rows()));
  const auto fitRows = [&](int first, int last) {
    for (int row = first; row < last; ++row) {
      for (int column = 0; column < layout.columns(); ++column) {
        lattice[indexOf(layout, column, row)] =
            fitAround(layout.point(column, row), reach, cells.around(column, row, reachColumns, reachRows));
      }
    }
  };
  const std::jthread second([&] { fitRows(layout.rows() / 2, layout.rows()); });
  fitRows(0, layout.rows() / 2);
  return lattice;
}

double keepLargestPart(DenseLattice& lattice, const DenseLayout& layout) {
  Parts parts(lattice, layout);
  parts.findAll();
  return parts.keepLargest();
}

}  // namespace pixelflex::calib
