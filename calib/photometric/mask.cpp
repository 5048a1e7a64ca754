#include "calib/photometric/mask.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <thread>

#include "calib/geometry/footprint.h"

namespace pixelflex::calib {
namespace {

double smoothStep(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Equation 7 for projectors among `candidates` only; `own` is the share asked for.
class ShareOfOne {
 public:
  ShareOfOne(std::size_t own, std::span<const ProjectorMapping> projectors, std::span<const double> densities,
             double exponent)
      : own_(own), projectors_(projectors) {
    const double reference = densities[own];  // only ratios matter: keeps p^n near one
    for (const double density : densities) priority_.push_back(std::pow(density / reference, exponent));
    const Outline ownArea = footprint(projectors[own]);
    for (std::size_t i = 0; i < projectors.size(); ++i) {
      if (i != own && mayOverlap(ownArea, footprint(projectors[i]))) others_.push_back(i);
    }
  }

  [[nodiscard]] double at(glm::dvec2 pointInOwn) const {
    const auto inWall = projectors_[own_].wallFromProjector(pointInOwn);
    if (!inWall) return 0;
    const double mine = edgeWeight(pointInOwn, projectors_[own_].resolution()) * priority_[own_];
    double sum = mine;
    for (const std::size_t other : others_) {
      const auto inOther = projectors_[other].projectorFromWall(*inWall);
      if (inOther) sum += edgeWeight(*inOther, projectors_[other].resolution()) * priority_[other];
    }
    return sum > 0 ? mine / sum : 0;
  }

 private:
  static bool mayOverlap(const Outline& a, const Outline& b) {
    const auto xs = [](const Outline& o) { return std::ranges::minmax(o, {}, &glm::dvec2::x); };
    const auto ys = [](const Outline& o) { return std::ranges::minmax(o, {}, &glm::dvec2::y); };
    const auto [aLeft, aRight] = xs(a);
    const auto [bLeft, bRight] = xs(b);
    const auto [aTop, aBottom] = ys(a);
    const auto [bTop, bBottom] = ys(b);
    return aLeft.x < bRight.x && bLeft.x < aRight.x && aTop.y < bBottom.y && bTop.y < aBottom.y;
  }

  std::size_t own_;
  std::span<const ProjectorMapping> projectors_;
  std::vector<double> priority_;
  std::vector<std::size_t> others_;
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
  const ShareOfOne share(projector, projectors, densities, densityExponent);
  devices::Image16 mask(projectors[projector].resolution(), 1);
  const auto fillRows = [&](int first, int step) {
    for (int y = first; y < mask.height(); y += step) {
      for (int x = 0; x < mask.width(); ++x) {
        mask.at(x, y) = static_cast<std::uint16_t>(std::lround(share.at({x + 0.5, y + 0.5}) * 65535));
      }
    }
  };
  const std::jthread oddRows(fillRows, 1, 2);
  fillRows(0, 2);
  return mask;
}

}  // namespace pixelflex::calib
