#include "calib/photometric/mask.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <numeric>
#include <optional>
#include <thread>
#include <vector>

#include "calib/geometry/footprint.h"

namespace pixelflex::calib {
namespace {

double smoothStep(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

struct Box {
  glm::dvec2 low, high;
};

Box boxOf(std::span<const glm::dvec2> points) {
  Box box{points.front(), points.front()};
  for (const glm::dvec2 p : points) box = {glm::min(box.low, p), glm::max(box.high, p)};
  return box;
}

/// With as much room on each side as the box is wide or high: far more than a mapping bends within a block of pixels.
Box widened(const Box& box) {
  const glm::dvec2 extent = box.high - box.low;
  return {box.low - extent, box.high + extent};
}

bool meet(const Box& a, const Box& b) {
  return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

/// What a projector wants of a wall point.
struct Claim {
  int layer = 0;      // 0 wins over 1 and so on
  double weight = 0;  // of equation 7: a * p^n
  double cover = 0;   // 0 at its border, 1 from the feather's width on
};

/// Smooth steps of the distances to the four edges, multiplied.
double featherOf(glm::dvec2 p, devices::Size frame, double width) {
  return smoothStep(p.x / width) * smoothStep((frame.width - p.x) / width) * smoothStep(p.y / width) *
         smoothStep((frame.height - p.y) / width);
}

class Priorities {
 public:
  Priorities(std::span<const double> densities, const MaskRules& rules)
      : feather_(rules.priorityFeather), layers_(densities.size(), 0) {
    std::vector<std::size_t> order(densities.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, std::ranges::greater(), [&](std::size_t i) { return densities[i]; });
    for (std::size_t k = 1; k < order.size() && feather_ > 0; ++k) {
      const bool apart = densities[order[k - 1]] > kLayerRatio * densities[order[k]];
      layers_[order[k]] = layers_[order[k - 1]] + (apart ? 1 : 0);
    }
    // Only ratios matter: dividing keeps p^n near one.
    for (const double p : densities) factors_.push_back(std::pow(p / densities[0], rules.densityExponent));
  }

  [[nodiscard]] Claim claim(std::size_t i, glm::dvec2 p, devices::Size frame) const {
    return {layers_[i], edgeWeight(p, frame) * factors_[i], feather_ > 0 ? featherOf(p, frame, feather_) : 0};
  }

  /// Of all that reach a point. With layers: what the layers above leave, times the cover of the own one, times the
  /// share within it, over what all layers together take; the last one may leave nothing dark.
  [[nodiscard]] double shareOf(std::size_t own, const std::vector<Claim>& claims) const {
    const int layer = claims[own].layer;
    double weights = 0;
    for (const Claim& claim : claims) weights += claim.layer == layer ? claim.weight : 0;
    if (weights <= 0) return 0;
    const double within = claims[own].weight / weights;
    if (feather_ <= 0) return within;
    double left = 1;
    double mine = 0;
    double taken = 0;
    const int lowest = std::ranges::max(claims, {}, &Claim::layer).layer;
    for (int l = 0; l <= lowest; ++l) {
      const double here = left * coverOf(l, claims);
      if (l == layer) mine = here;
      taken += here;
      left -= here;
    }
    return taken > 0 ? within * mine / taken : 0;
  }

 private:
  static double coverOf(int layer, const std::vector<Claim>& claims) {
    double open = 1;
    for (const Claim& claim : claims) open *= claim.layer == layer ? 1 - claim.cover : 1;
    return 1 - open;
  }

  double feather_;
  std::vector<int> layers_;
  std::vector<double> factors_;
};

constexpr int kBlock = 16;  // pixels

/// Pixels [left, right) x [top, bottom) of a frame.
struct Block {
  int left, top, right, bottom;
};

/// Paints equation 7 for one projector, block by block: most blocks are lit by it alone, and there is nothing to do.
class MaskPainter {
 public:
  MaskPainter(std::size_t own, std::span<const ProjectorMapping> projectors, std::span<const double> densities,
              const MaskRules& rules, devices::Image16& mask)
      : own_(projectors[own]), priorities_(densities, rules), ownIndex_(own), mask_(mask) {
    const Box ownArea = boxOf(footprint(own_));
    for (std::size_t i = 0; i < projectors.size(); ++i) {
      const Other other{&projectors[i], i, boxOf(footprint(projectors[i]))};
      if (i != own && meet(ownArea, other.area)) others_.push_back(other);
    }
  }

  /// The blocks whose upper edge is `top`.
  void paintBlocks(int top) const {
    for (int left = 0; left < mask_.width(); left += kBlock) {
      paint({left, top, std::min(left + kBlock, mask_.width()), std::min(top + kBlock, mask_.height())});
    }
  }

 private:
  struct Other {
    const ProjectorMapping* mapping;
    std::size_t index;
    Box area;  // in wall
  };

  void paint(const Block& block) const {
    const auto corners = cornersInWall(block);
    std::vector<const Other*> reaching;
    for (const Other& other : others_) {
      if (!corners || mayReach(other, *corners)) reaching.push_back(&other);
    }
    const bool alone = corners && reaching.empty();
    for (int y = block.top; y < block.bottom; ++y) {
      for (int x = block.left; x < block.right; ++x) {
        const double share = alone ? 1 : shareAt({x + 0.5, y + 0.5}, reaching);
        mask_.at(x, y) = static_cast<std::uint16_t>(std::lround(share * 65535));
      }
    }
  }

  [[nodiscard]] std::optional<std::array<glm::dvec2, 4>> cornersInWall(const Block& block) const {
    std::array<glm::dvec2, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto corner =
          own_.wallFromProjector({i % 2 == 0 ? block.left : block.right, i / 2 == 0 ? block.top : block.bottom});
      if (!corner) return std::nullopt;
      corners[i] = *corner;
    }
    return corners;
  }

  /// Never false where the other's light reaches a block with these corners.
  static bool mayReach(const Other& other, const std::array<glm::dvec2, 4>& cornersInWall) {
    if (!meet(widened(boxOf(cornersInWall)), other.area)) return false;
    std::array<glm::dvec2, 4> cornersInOther{};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto corner = other.mapping->projectorFromWall(cornersInWall[i]);
      if (!corner) return true;
      cornersInOther[i] = *corner;
    }
    const devices::Size frame = other.mapping->resolution();
    return meet(widened(boxOf(cornersInOther)), {{0, 0}, {frame.width, frame.height}});
  }

  [[nodiscard]] double shareAt(glm::dvec2 pointInOwn, const std::vector<const Other*>& others) const {
    const auto inWall = own_.wallFromProjector(pointInOwn);
    if (!inWall) return 0;
    std::vector<Claim> claims = {priorities_.claim(ownIndex_, pointInOwn, own_.resolution())};
    for (const Other* other : others) {
      const auto inOther = other->mapping->projectorFromWall(*inWall);
      if (inOther) claims.push_back(priorities_.claim(other->index, *inOther, other->mapping->resolution()));
    }
    return priorities_.shareOf(0, claims);
  }

  const ProjectorMapping& own_;
  Priorities priorities_;
  std::size_t ownIndex_;
  devices::Image16& mask_;
  std::vector<Other> others_;
};

}  // namespace

double edgeWeight(glm::dvec2 p, devices::Size resolution) {
  return featherOf(p, resolution, 0.25 * std::min(resolution.width, resolution.height));
}

std::vector<double> blendShares(glm::dvec2 pointInWall, std::span<const ProjectorMapping> projectors,
                                std::span<const double> densities, const MaskRules& rules) {
  const Priorities priorities(densities, rules);
  std::vector<Claim> claims;
  std::vector<std::size_t> claiming;
  for (std::size_t i = 0; i < projectors.size(); ++i) {
    const auto inProjector = projectors[i].projectorFromWall(pointInWall);
    if (!inProjector) continue;
    claims.push_back(priorities.claim(i, *inProjector, projectors[i].resolution()));
    claiming.push_back(i);
  }
  std::vector<double> shares(projectors.size(), 0.0);
  for (std::size_t k = 0; k < claims.size(); ++k) shares[claiming[k]] = priorities.shareOf(k, claims);
  return shares;
}

devices::Image16 alphaMask(std::size_t projector, std::span<const ProjectorMapping> projectors,
                           std::span<const double> densities, const MaskRules& rules) {
  assert(projector < projectors.size() && projectors.size() == densities.size());
  devices::Image16 mask(projectors[projector].resolution(), 1);
  const MaskPainter painter(projector, projectors, densities, rules, mask);
  const auto paintRows = [&](int first) {
    for (int y = first * kBlock; y < mask.height(); y += 2 * kBlock) painter.paintBlocks(y);
  };
  {
    const std::jthread oddRows(paintRows, 1);
    paintRows(0);
  }
  return mask;
}

}  // namespace pixelflex::calib
