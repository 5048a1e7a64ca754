#include "calib/patterns/blob_edges.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <vector>

namespace pixelflex::calib {
namespace {

/// Where light falls to half along a line across the frame's edge.
struct Crossing {
  double beyond = 0;          // outwards of where the blobs expect it, camera pixels
  double width = 0;           // from 80 to 20 %
  glm::dvec2 outwards{0, 0};  // in the camera, of length 1
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A line of blobs towards the frame's edge, continued beyond the last: a cubic through the last four, which follows
/// perspective and the bend of a wide lens.
class Line {
 public:
  explicit Line(const std::array<glm::dvec2, 4>& fromTheLast) : nodes_(fromTheLast) {}

  /// `u`: 0 at the last blob, 1 a blob's distance further out.
  [[nodiscard]] glm::dvec2 at(double u) const {
    return nodes_[0] * ((u + 1) * (u + 2) * (u + 3) / 6) - nodes_[1] * (u * (u + 2) * (u + 3) / 2) +
           nodes_[2] * (u * (u + 1) * (u + 3) / 2) - nodes_[3] * (u * (u + 1) * (u + 2) / 6);
  }

 private:
  std::array<glm::dvec2, 4> nodes_;
};

class EdgeSearch {
 public:
  EdgeSearch(const FrameLight& frame, const Grid& grid, const BlobLayout& layout) : frame_(frame), layout_(layout) {
    for (const auto& spot : grid.spots) pointsInRaw_[static_cast<std::size_t>(spot.id - 1)] = spot.pointInRaw;
  }

  FrameEdges run() {
    constexpr int kLast = kBlobCount - kBlobColumns;
    // Corners are left out: two edges meet there.
    for (int i = 1; i + 1 < kBlobColumns; ++i) {
      search(0, i, kBlobColumns);
      search(1, kLast + i, -kBlobColumns);
      search(2, i * kBlobColumns, 1);
      search(3, (i + 1) * kBlobColumns - 1, -1);
    }
    return summary();
  }

 private:
  /// The line of blobs that ends at `last`; `inwards` leads from one of its blobs to the next.
  void search(std::size_t side, int last, int inwards) {
    std::array<glm::dvec2, 4> nodes{};
    int index = last;
    for (auto& node : nodes) {
      const auto& point = pointsInRaw_[static_cast<std::size_t>(index)];
      if (!point) return;
      node = *point;
      index += inwards;
    }
    const glm::dvec2 centre = layout_.centre(last + 1);
    const double spacing = glm::length(layout_.centre(last + inwards + 1) - centre);
    const auto resolution = layout_.resolution();
    const std::array<double, 4> toEdge = {centre.y, resolution.height - centre.y, centre.x,
                                          resolution.width - centre.x};
    if (const auto found = cross(Line(nodes), toEdge[side] / spacing, 3 * layout_.sigma() / spacing)) {
      crossings_[side].push_back(*found);
    }
  }

  /// Around `edge` by `reach` to each side, both along the line.
  [[nodiscard]] std::optional<Crossing> cross(const Line& line, double edge, double reach) const {
    constexpr std::size_t kSteps = 60;  // to each side
    constexpr std::size_t kInner = 20;  // of these tell how bright the frame is
    const glm::dvec2 expected = line.at(edge);
    std::array<double, 2 * kSteps + 1> light{};
    std::array<double, 2 * kSteps + 1> at{};
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double beyond = static_cast<double>(i) / kSteps - 1;  // in parts of the reach
      const glm::dvec2 raw = line.at(edge + reach * beyond);
      if (raw.x < 1 || raw.y < 1 || raw.x > frame_.range.width() - 1.0 || raw.y > frame_.range.height() - 1.0) {
        return std::nullopt;
      }
      light[i] = sample(raw);
      at[i] = std::copysign(glm::length(raw - expected), beyond);
    }
    double inside = 0;
    for (std::size_t i = 0; i < kInner; ++i) inside += light[i] / kInner;
    if (inside < 0.4 * frame_.level) return std::nullopt;  // something dark stands here
    const auto place = [&](double share) {
      for (std::size_t i = 1; i < light.size(); ++i) {
        if (light[i] > share * inside) continue;
        const double t = (light[i - 1] - share * inside) / (light[i - 1] - light[i]);
        return at[i - 1] + t * (at[i] - at[i - 1]);
      }
      return at.back() + 1;
    };
    const double half = place(0.5);
    if (half > at.back()) return std::nullopt;
    const glm::dvec2 outwards = line.at(edge + reach) - expected;
    return Crossing{half, place(0.2) - place(0.8), outwards / glm::length(outwards)};
  }

  [[nodiscard]] double sample(glm::dvec2 raw) const {
    const double x = raw.x - 0.5;
    const double y = raw.y - 0.5;
    const int x0 = static_cast<int>(std::floor(x));
    const int y0 = static_cast<int>(std::floor(y));
    const double u = x - x0;
    const double v = y - y0;
    const auto at = [&](int i, int k) {
      return double(
          frame_.range.at(std::clamp(i, 0, frame_.range.width() - 1), std::clamp(k, 0, frame_.range.height() - 1)));
    };
    return (1 - v) * ((1 - u) * at(x0, y0) + u * at(x0 + 1, y0)) +
           v * ((1 - u) * at(x0, y0 + 1) + u * at(x0 + 1, y0 + 1));
  }

  [[nodiscard]] FrameEdges summary() const {
    FrameEdges edges;
    std::vector<double> widths;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const auto& side : crossings_) {
      if (side.size() < 4) continue;
      ++edges.sides;
      std::vector<double> beyond;
      glm::dvec2 outwards{0, 0};
      for (const auto& crossing : side) {
        beyond.push_back(crossing.beyond);
        widths.push_back(crossing.width);
        outwards += crossing.outwards / double(side.size());
      }
      // The frame may be shifted, and look a little larger than it is.
      const Eigen::Vector3d row(outwards.x, outwards.y, 1);
      normal += row * row.transpose();
      right += row * median(beyond);
    }
    constexpr double kWidthOfSigma = 1.683;  // of a Gaussian's integral, from 20 to 80 %
    if (!widths.empty()) edges.blur = median(widths) / kWidthOfSigma;
    if (edges.sides < 3) return edges;
    const Eigen::Vector3d solution = normal.ldlt().solve(right);
    edges.shift = {solution[0], solution[1]};
    return edges;
  }

  const FrameLight& frame_;
  const BlobLayout& layout_;
  std::array<std::optional<glm::dvec2>, kBlobCount> pointsInRaw_;
  std::array<std::vector<Crossing>, 4> crossings_;
};

}  // namespace

FrameEdges measureEdges(const FrameLight& frame, const Grid& grid, const BlobLayout& layout) {
  return EdgeSearch(frame, grid, layout).run();
}

}  // namespace pixelflex::calib
