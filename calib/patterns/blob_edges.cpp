#include "calib/patterns/blob_edges.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
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

class EdgeSearch {
 public:
  EdgeSearch(const FrameLight& frame, const Grid& grid, const BlobLayout& layout, const CameraMapping& camera)
      : frame_(frame), grid_(grid), layout_(layout), camera_(camera) {}

  FrameEdges run() {
    // Corners are left out: two edges meet there.
    for (int i = 1; i + 1 < kBlobColumns; ++i) {
      search(0, i, {0, -1});
      search(1, (kBlobRows - 1) * kBlobColumns + i, {0, 1});
      search(2, i * kBlobColumns, {-1, 0});
      search(3, i * kBlobColumns + kBlobColumns - 1, {1, 0});
    }
    return summary();
  }

 private:
  /// Lines across the edge beside a blob, outwards in the projector.
  void search(std::size_t side, int index, glm::dvec2 outwards) {
    const int id = index + 1;
    if (std::ranges::find(grid_.spots, id, &GridSpot::id) == grid_.spots.end()) return;
    const Homography cameraFromProjector = mapAround(id, grid_, layout_);
    const glm::dvec2 centre = layout_.centre(id);
    const auto resolution = layout_.resolution();
    const glm::dvec2 edge{outwards.x > 0 ? resolution.width : 0, outwards.y > 0 ? resolution.height : 0};
    const glm::dvec2 along{std::abs(outwards.y), std::abs(outwards.x)};
    for (const double aside : {-2.0, 0.0, 2.0}) {
      const glm::dvec2 from = outwards.x != 0 ? glm::dvec2(edge.x, centre.y) : glm::dvec2(centre.x, edge.y);
      if (const auto found = cross(from + along * aside * layout_.sigma(), outwards, cameraFromProjector)) {
        crossings_[side].push_back(*found);
      }
    }
  }

  [[nodiscard]] glm::dvec2 toRaw(const Homography& cameraFromProjector, glm::dvec2 pointInProjector) const {
    return camera_.rawFromUndistorted(cameraFromProjector.map(pointInProjector));
  }

  [[nodiscard]] std::optional<Crossing> cross(glm::dvec2 onEdge, glm::dvec2 outwards,
                                              const Homography& cameraFromProjector) const {
    constexpr int kSteps = 60;  // to each side
    const double reach = 3 * layout_.sigma();
    const glm::dvec2 expected = toRaw(cameraFromProjector, onEdge);
    std::array<double, 2 * kSteps + 1> light{};
    std::array<double, 2 * kSteps + 1> at{};
    for (int i = -kSteps; i <= kSteps; ++i) {
      const glm::dvec2 raw = toRaw(cameraFromProjector, onEdge + outwards * (reach * i / kSteps));
      if (raw.x < 1 || raw.y < 1 || raw.x > frame_.range.width() - 1.0 || raw.y > frame_.range.height() - 1.0) {
        return std::nullopt;
      }
      light[static_cast<std::size_t>(i + kSteps)] = sample(raw);
      at[static_cast<std::size_t>(i + kSteps)] = std::copysign(glm::length(raw - expected), i);
    }
    double inside = 0;
    for (std::size_t i = 0; i < kSteps / 3; ++i) inside += light[i] / (kSteps / 3);
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
    const glm::dvec2 direction = toRaw(cameraFromProjector, onEdge + outwards) - expected;
    return Crossing{half, place(0.2) - place(0.8), direction / glm::length(direction)};
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
      if (side.size() < 6) continue;
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
  const Grid& grid_;
  const BlobLayout& layout_;
  const CameraMapping& camera_;
  std::array<std::vector<Crossing>, 4> crossings_;
};

}  // namespace

FrameEdges measureEdges(const FrameLight& frame, const Grid& grid, const BlobLayout& layout,
                        const CameraMapping& camera) {
  return EdgeSearch(frame, grid, layout, camera).run();
}

}  // namespace pixelflex::calib
