#include "calib/estimate/smooth_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace pixelflex::calib {
namespace {

using devices::ImageF;

constexpr int kTerms = 6;
using Terms = Eigen::Matrix<double, kTerms, 1>;
using Surface = Eigen::Matrix<double, kTerms, 3>;  // a column a channel

constexpr int kBlock = 2;               // nodes, both ways, that share a surface
constexpr double kFewestSeen = 0.4;     // of a neighbourhood
constexpr int kRounds = 3;              // of setting aside what stands out
constexpr double kOutlier = 4.685;      // Tukey's constant, in standard deviations
constexpr double kLeastSpread = 0.001;  // relative: closer than this nothing stands out

Terms termsAt(double x, double y) {
  return Terms{1, x, y, x * x, x * y, y * y};
}

/// Nodes [left, left + extent.x) x [top, top + extent.y).
struct Neighbourhood {
  int left, top, width, height;
};

class FieldSmoother {
 public:
  explicit FieldSmoother(const ImageF& field) : field_(field) {}

  ImageF smooth() {
    ImageF result(field_.size(), 3);
    for (int y = 0; y < field_.height(); y += kBlock) {
      for (int x = 0; x < field_.width(); x += kBlock) fillBlock(x, y, result);
    }
    return result;
  }

 private:
  struct Node {
    int x, y;
    Terms terms;
    double level;  // sum of the channels
    double weight;
  };

  [[nodiscard]] static int clampedStart(int middle, int extent, int count) {
    return std::clamp(middle - extent / 2, 0, std::max(0, count - extent));
  }

  [[nodiscard]] Neighbourhood around(int x, int y) const {
    const int extent = std::max(5, std::max(field_.width(), field_.height()) / 8);
    const int width = std::min(extent, field_.width());
    const int height = std::min(extent, field_.height());
    return {clampedStart(x, width, field_.width()), clampedStart(y, height, field_.height()), width, height};
  }

  void gather(const Neighbourhood& area, int blockX, int blockY) {
    nodes_.clear();
    const double unit = 0.5 * std::max(area.width, area.height);
    for (int y = area.top; y < area.top + area.height; ++y) {
      for (int x = area.left; x < area.left + area.width; ++x) {
        const double level = field_.at(x, y, 0) + field_.at(x, y, 1) + field_.at(x, y, 2);
        if (field_.at(x, y, 1) > 0)
          nodes_.push_back({x, y, termsAt((x - blockX) / unit, (y - blockY) / unit), level, 1});
      }
    }
  }

  [[nodiscard]] Surface fit() const {
    Eigen::Matrix<double, kTerms, kTerms> normal = Eigen::Matrix<double, kTerms, kTerms>::Identity() * 1e-9;
    Surface right = Surface::Zero();
    for (const Node& node : nodes_) {
      const double weight = node.weight;
      normal += weight * node.terms * node.terms.transpose();
      const Eigen::RowVector3d light(field_.at(node.x, node.y, 0), field_.at(node.x, node.y, 1),
                                     field_.at(node.x, node.y, 2));
      right += weight * node.terms * light;
    }
    return normal.ldlt().solve(right);
  }

  /// Relative distances from the surface decide how much each node still counts.
  void reweigh(const Surface& surface) {
    errors_.clear();
    const Terms level = surface.rowwise().sum();
    for (const Node& node : nodes_) errors_.push_back(std::abs(node.terms.dot(level) / node.level - 1));
    sorted_ = errors_;
    const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
    std::ranges::nth_element(sorted_, middle);
    const double limit = kOutlier * std::max(kLeastSpread, 1.4826 * *middle);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const double far = errors_[i] / limit;
      nodes_[i].weight = far < 1 ? (1 - far * far) * (1 - far * far) : 0;
    }
  }

  void fillBlock(int blockX, int blockY, ImageF& result) {
    const Neighbourhood area = around(blockX, blockY);
    gather(area, blockX, blockY);
    if (static_cast<double>(nodes_.size()) < kFewestSeen * area.width * area.height) return;
    Surface surface = fit();
    for (int round = 0; round < kRounds; ++round) {
      reweigh(surface);
      surface = fit();
    }
    const double unit = 0.5 * std::max(area.width, area.height);
    for (int y = blockY; y < std::min(blockY + kBlock, field_.height()); ++y) {
      for (int x = blockX; x < std::min(blockX + kBlock, field_.width()); ++x) {
        const Eigen::RowVector3d light = termsAt((x - blockX) / unit, (y - blockY) / unit).transpose() * surface;
        for (int c = 0; c < 3; ++c) result.at(x, y, c) = static_cast<float>(std::max(0.0, light(c)));
      }
    }
  }

  const ImageF& field_;
  std::vector<Node> nodes_;
  std::vector<double> errors_, sorted_;
};

}  // namespace

ImageF smoothField(const ImageF& field) {
  return FieldSmoother(field).smooth();
}

}  // namespace pixelflex::calib
