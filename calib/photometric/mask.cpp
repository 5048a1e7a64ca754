#include "calib/photometric/mask.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <optional>
#include <thread>

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

constexpr int kBlock = 16;  // pixels

/// Pixels [left, right) x [top, bottom) of a frame.
struct Block {
  int left, top, right, bottom;
};

/// Paints equation 7 for one projector, block by block: most blocks are lit by it alone, and there is nothing to do.
class MaskPainter {
 public:
  MaskPainter(std::size_t own, std::span<const ProjectorMapping> projectors, std::span<const double> densities,
              double exponent, devices::Image16& mask)
      : own_(projectors[own]), mask_(mask) {
    const double reference = densities[own];  // only ratios matter: keeps p^n near one
    ownPriority_ = std::pow(densities[own] / reference, exponent);
    const Box ownArea = boxOf(footprint(own_));
    for (std::size_t i = 0; i < projectors.size(); ++i) {
      const Other other{&projectors[i], std::pow(densities[i] / reference, exponent), boxOf(footprint(projectors[i]))};
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
    double priority;
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
    const double mine = edgeWeight(pointInOwn, own_.resolution()) * ownPriority_;
    double sum = mine;
    for (const Other* other : others) {
      const auto inOther = other->mapping->projectorFromWall(*inWall);
      if (inOther) sum += edgeWeight(*inOther, other->mapping->resolution()) * other->priority;
    }
    return sum > 0 ? mine / sum : 0;
  }

  const ProjectorMapping& own_;
  devices::Image16& mask_;
  double ownPriority_ = 1;
  std::vector<Other> others_;
};

}  // namespace

double edgeWeight(glm::dvec2 p, devices::Size resolution) {
  const double w = resolution.width;
  const double h = resolution.height;
  const double feather = 0.25 * std::min(w, h);
  return smoothStep(p.x / feather) * smoothStep((w - p.x) / feather) * smoothStep(p.y / feather) *
         smoothStep((h - p.y) / feather);
}

std::vector<double> blendShares(glm::dvec2 pointInWall, std::span<const ProjectorMapping> projectors,
                                std::span<const double> densities, double densityExponent) {
  std::vector<double> shares(projectors.size(), 0.0);
  double sum = 0;
  for (std::size_t i = 0; i < projectors.size(); ++i) {
    const auto inProjector = projectors[i].projectorFromWall(pointInWall);
    if (!inProjector) continue;
    shares[i] =
        edgeWeight(*inProjector, projectors[i].resolution()) * std::pow(densities[i] / densities[0], densityExponent);
    sum += shares[i];
  }
  for (double& share : shares) share = sum > 0 ? share / sum : 0;
  return shares;
}

devices::Image16 alphaMask(std::size_t projector, std::span<const ProjectorMapping> projectors,
                           std::span<const double> densities, double densityExponent) {
  assert(projector < projectors.size() && projectors.size() == densities.size());
  devices::Image16 mask(projectors[projector].resolution(), 1);
  const MaskPainter painter(projector, projectors, densities, densityExponent, mask);
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
