#include "calib/photometric/luminance_target.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

#include "calib/photometric/light_error.h"
#include "calib/photometric/smooth_bound.h"

namespace pixelflex::calib {
namespace {

struct Source {
  double white;
  double share;
};

/// What the shares may leave dark of the target: where a projector has next to no share it need not reach the target,
/// or the dim edge of every frame would darken its brighter neighbour.
constexpr double kTolerance = 0.001;

/// The largest luminance l with sum of share * min(white, l) >= (1 - kTolerance) l; the shares sum to one.
double reachable(std::vector<Source>& sources) {
  std::ranges::sort(sources, {}, &Source::white);
  double light = 0;  // of those that give all they have
  double share = 0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    light += sources[i].share * sources[i].white;
    share += sources[i].share;
    if (share <= kTolerance) continue;
    const double level = std::max(sources[i].white, light / (share - kTolerance));
    if (i + 1 == sources.size() || level <= sources[i + 1].white) return level;
  }
  return light;
}

std::vector<Source> sourcesAt(std::span<const ProjectorLightMaps> projectors, std::size_t pixel) {
  std::vector<Source> sources;
  double sum = 0;
  for (const auto& maps : projectors) {
    const Source source{maps.white.samples()[pixel], maps.share.samples()[pixel]};
    if (!(source.white > 0 && source.share > 0)) continue;
    sources.push_back(source);
    sum += source.share;
  }
  for (auto& source : sources) source.share /= sum;
  return sources;
}

}  // namespace

double luminanceGradientPerDegree(double uniformity) {
  assert(uniformity >= 0 && uniformity <= 1);
  constexpr double kSteepest = 0.1;
  constexpr double kUnseen = 0.0055;
  if (uniformity <= 0) return kSteepest;
  return std::min(kSteepest, kUnseen * std::pow((1 - uniformity) / uniformity, 1.5));
}

LuminanceTarget luminanceTarget(std::span<const ProjectorLightMaps> projectors, double uniformity,
                                double pixelsPerDegree) {
  assert(!projectors.empty() && pixelsPerDegree > 0);
  LuminanceTarget result{.available = devices::ImageF(projectors[0].white.size(), 1), .target = {}};
  double brightest = 0;
  for (std::size_t i = 0; i < result.available.samples().size(); ++i) {
    auto sources = sourcesAt(projectors, i);
    if (sources.empty()) continue;
    for (const auto& source : sources) brightest += source.share * source.white;
    result.available.samples()[i] = static_cast<float>(reachable(sources));
  }
  if (!(brightest > 0)) {
    throw LightError("no projector's white is seen in the display area: photograph the white fields again");
  }
  result.target = smoothBelow(result.available, luminanceGradientPerDegree(uniformity) / pixelsPerDegree);
  double sum = 0;
  for (const float value : result.target.samples()) sum += value;
  result.kept = sum / brightest;
  return result;
}

devices::Image16 gainMap(const ProjectorMapping& projector, const devices::ImageF& white, const devices::ImageF& target,
                         const WallRaster& raster, devices::Size size) {
  assert(white.size() == raster.size && target.size() == raster.size);
  constexpr int kReach = 16;  // samples beyond the display area take the gain of its border
  const devices::Size frame = projector.resolution();
  devices::Image16 map(size, 1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      map.at(x, y) = 65535;
      const auto inWall =
          projector.wallFromProjector({(x + 0.5) * frame.width / size.width, (y + 0.5) * frame.height / size.height});
      if (!inWall) continue;
      const auto at = raster.rasterFromWall(*inWall);
      const auto has = valueNear(white, at, kReach);
      const auto wanted = valueNear(target, at, kReach);
      if (has && wanted) map.at(x, y) = static_cast<std::uint16_t>(std::lround(65535 * std::min(1.0, *wanted / *has)));
    }
  }
  return map;
}

}  // namespace pixelflex::calib
