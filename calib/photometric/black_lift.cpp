#include "calib/photometric/black_lift.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <optional>
#include <vector>

#include "calib/photometric/light_error.h"
#include "calib/photometric/smooth_bound.h"

namespace pixelflex::calib {
namespace {

using devices::ImageF;
using MaybePoint = std::optional<glm::dvec2>;

constexpr int kBlock = 16;     // pixels
constexpr double kMargin = 2;  // pixels: further from a border than mappings bend within a block
constexpr int kNear = 4;       // raster pixels

/// The part of a pixel at `p` of `extent` that the frame covers.
double coverage(glm::dvec2 p, glm::dvec2 extent, devices::Size frame) {
  const auto inside = [](double distance, double width) { return std::clamp(distance / width + 0.5, 0.0, 1.0); };
  return inside(p.x, extent.x) * inside(p.y, extent.y) * inside(frame.width - p.x, extent.x) *
         inside(frame.height - p.y, extent.y);
}

enum class Side { kInside, kOutside, kBorder };

/// Where a block with these corners lies in a frame; kBorder in doubt.
Side sideOf(const std::array<MaybePoint, 4>& corners, devices::Size frame) {
  const auto all = [&](auto&& test) {
    return std::ranges::all_of(corners, [&](const MaybePoint& p) { return p && test(*p); });
  };
  const double w = frame.width;
  const double h = frame.height;
  if (std::ranges::none_of(corners, [](const MaybePoint& p) { return p.has_value(); })) return Side::kOutside;
  if (all([&](glm::dvec2 p) { return p.x < -kMargin; }) || all([&](glm::dvec2 p) { return p.y < -kMargin; }) ||
      all([&](glm::dvec2 p) { return p.x > w + kMargin; }) || all([&](glm::dvec2 p) { return p.y > h + kMargin; })) {
    return Side::kOutside;
  }
  const bool inside =
      all([&](glm::dvec2 p) { return p.x > kMargin && p.x < w - kMargin && p.y > kMargin && p.y < h - kMargin; });
  return inside ? Side::kInside : Side::kBorder;
}

/// Paints block by block: between the borders of frames the lift is smooth, and the corners of a block tell it.
class LiftPainter {
 public:
  LiftPainter(std::size_t own, std::span<const ProjectorMapping> mappings,
              std::span<const ProjectorLightMaps> projectors, const BlackTarget& black, const WallRaster& raster,
              double largest)
      : own_(own), mappings_(mappings), projectors_(projectors), black_(black), raster_(raster), largest_(largest) {
    const devices::Size frame = mappings[own].resolution();
    columns_ = (frame.width + kBlock - 1) / kBlock + 1;
    rows_ = (frame.height + kBlock - 1) / kBlock + 1;
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) addNode(glm::dvec2(column, row) * double{kBlock});
    }
  }

  void paint(const devices::Image16& alpha, devices::Image16& map) const {
    for (int row = 0; row + 1 < rows_; ++row) {
      for (int column = 0; column + 1 < columns_; ++column) paintBlock(column, row, alpha, map);
    }
  }

 private:
  void addNode(glm::dvec2 pointInOwn) {
    const auto inWall = mappings_[own_].wallFromProjector(pointInOwn);
    double leak = 0;
    for (std::size_t i = 0; i < mappings_.size(); ++i) {
      points_.push_back(inWall ? mappings_[i].projectorFromWall(*inWall) : std::nullopt);
      const bool lit = points_.back() && (i == own_ || mappings_[i].insideFrame(*points_.back()));
      if (lit) leak += leakOf(i, *inWall);
    }
    lifts_.push_back(inWall ? lift(*inWall, leak) : 0);
  }

  [[nodiscard]] double leakOf(std::size_t projector, glm::dvec2 pointInWall) const {
    return valueNear(projectors_[projector].black, raster_.rasterFromWall(pointInWall), kNear).value_or(0);
  }

  /// Of the own white, where `leak` is there already.
  [[nodiscard]] double lift(glm::dvec2 pointInWall, double leak) const {
    const auto at = raster_.rasterFromWall(pointInWall);
    const auto wanted = valueNear(black_.target, at, kNear);
    const auto white = valueNear(projectors_[own_].white, at, kNear);
    return wanted && white ? std::max(0.0, *wanted - leak) / *white : 0;
  }

  [[nodiscard]] std::array<std::size_t, 4> cornersOf(int column, int row) const {
    const auto first =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    const auto below = first + static_cast<std::size_t>(columns_);
    return {first, first + 1, below, below + 1};
  }

  [[nodiscard]] Side sideIn(std::size_t projector, const std::array<MaybePoint, 4>& points) const {
    if (projector != own_) return sideOf(points, mappings_[projector].resolution());
    const bool known = std::ranges::all_of(points, [](const MaybePoint& p) { return p.has_value(); });
    return known ? Side::kInside : Side::kBorder;
  }

  void paintBlock(int column, int row, const devices::Image16& alpha, devices::Image16& map) const {
    const auto corners = cornersOf(column, row);
    std::vector<std::size_t> lit;
    bool smooth = true;
    for (std::size_t i = 0; i < mappings_.size(); ++i) {
      std::array<MaybePoint, 4> points;
      for (std::size_t k = 0; k < 4; ++k) points.at(k) = points_[corners.at(k) * mappings_.size() + i];
      const Side side = sideIn(i, points);
      if (side != Side::kOutside) lit.push_back(i);
      smooth = smooth && side != Side::kBorder;
    }
    const glm::ivec2 first(column * kBlock, row * kBlock);
    for (int y = first.y; y < std::min(first.y + kBlock, map.height()); ++y) {
      for (int x = first.x; x < std::min(first.x + kBlock, map.width()); ++x) {
        if (alpha.at(x, y) == 0) continue;
        const glm::dvec2 centre(x + 0.5, y + 0.5);
        const double lift =
            smooth ? between(corners, (centre - glm::dvec2(first)) / double{kBlock}) : exactLift(centre, lit, corners);
        const double part = std::min(1.0, lift * alpha.at(x, y) / 65535 / largest_);
        map.at(x, y) = static_cast<std::uint16_t>(std::lround(65535 * part));
      }
    }
  }

  [[nodiscard]] double between(const std::array<std::size_t, 4>& corners, glm::dvec2 t) const {
    const double top = lifts_[corners[0]] * (1 - t.x) + lifts_[corners[1]] * t.x;
    const double bottom = lifts_[corners[2]] * (1 - t.x) + lifts_[corners[3]] * t.x;
    return top * (1 - t.y) + bottom * t.y;
  }

  /// Of an own pixel in another projector's, along its axes; one pixel where that is not known.
  [[nodiscard]] glm::dvec2 extentIn(std::size_t projector, const std::array<std::size_t, 4>& corners) const {
    const auto point = [&](std::size_t k) { return points_[corners.at(k) * mappings_.size() + projector]; };
    if (!point(0) || !point(1) || !point(2)) return glm::dvec2(1);
    return (glm::abs(*point(1) - *point(0)) + glm::abs(*point(2) - *point(0))) / double{kBlock};
  }

  [[nodiscard]] double exactLift(glm::dvec2 pointInOwn, const std::vector<std::size_t>& lit,
                                 const std::array<std::size_t, 4>& corners) const {
    const auto inWall = mappings_[own_].wallFromProjector(pointInOwn);
    if (!inWall) return 0;
    double leak = 0;
    for (const std::size_t i : lit) {
      const auto point = mappings_[i].projectorFromWall(*inWall);
      const double part = i == own_ ? 1 : point ? coverage(*point, extentIn(i, corners), mappings_[i].resolution()) : 0;
      if (part > 0) leak += part * leakOf(i, *inWall);
    }
    return lift(*inWall, leak);
  }

  std::size_t own_;
  std::span<const ProjectorMapping> mappings_;
  std::span<const ProjectorLightMaps> projectors_;
  const BlackTarget& black_;
  const WallRaster& raster_;
  double largest_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<MaybePoint> points_;  // of every corner of a block, in each projector
  std::vector<double> lifts_;       // at the same corners
};

/// Sums over the display area.
struct Totals {
  double white = 0, leak = 0, black = 0;
};

}  // namespace

BlackTarget blackTarget(std::span<const ProjectorLightMaps> projectors, const ImageF& luminance, double gradient) {
  ImageF leak(luminance.size(), 1);
  for (const auto& maps : projectors) {
    assert(maps.black.size() == luminance.size());
    for (std::size_t i = 0; i < leak.samples().size(); ++i) leak.samples()[i] += maps.black.samples()[i];
  }
  BlackTarget result{.target = smoothAbove(leak, gradient)};
  Totals totals;
  for (std::size_t i = 0; i < leak.samples().size(); ++i) {
    if (!(luminance.samples()[i] > 0)) continue;
    totals.white += luminance.samples()[i];
    totals.leak += leak.samples()[i];
    totals.black += result.target.samples()[i];
    const double lift = result.target.samples()[i] - leak.samples()[i];
    for (const auto& maps : projectors) {
      const double white = maps.white.samples()[i];
      if (white > 0) result.largestLift = std::max(result.largestLift, maps.share.samples()[i] * lift / white);
    }
  }
  if (!(totals.leak > 0)) {
    throw LightError(
        "no projector's black is seen in the display area: photograph the black fields with longer "
        "exposures, or choose black: native");
  }
  result.contrastNative = 1 + totals.white / totals.leak;
  result.contrastEven = 1 + totals.white / totals.black;
  return result;
}

devices::Image16 blackLiftMap(std::size_t own, std::span<const ProjectorMapping> mappings,
                              std::span<const ProjectorLightMaps> projectors, const BlackTarget& black,
                              const WallRaster& raster, const devices::Image16& alpha, double largest) {
  assert(own < mappings.size() && mappings.size() == projectors.size());
  assert(alpha.size() == mappings[own].resolution());
  devices::Image16 map(alpha.size(), 1);
  LiftPainter(own, mappings, projectors, black, raster, largest).paint(alpha, map);
  return map;
}

}  // namespace pixelflex::calib
