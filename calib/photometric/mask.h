#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "calib/geometry/projector_mapping.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The distance term a of equation 7 for a point of a frame: a smooth step of the distance to each of the four edges,
/// multiplied. Zero on the edge and outside, one further than a quarter of the frame's shorter side from every edge;
/// without the ridges that the plain distance has along its medial axis.
[[nodiscard]] double edgeWeight(glm::dvec2 pointInProjector, devices::Size resolution);

/// How overlapping projectors share the light.
struct MaskRules {
  double densityExponent = 2;  // n of equation 7
  /// 0: equation 7 alone. Else denser projectors lie above others (kLayerRatio) and win: their light ramps up from
  /// their borders within this many of their own pixels, whatever the ratio of densities; equation 7 shares among those
  /// of a layer.
  double priorityFeather = 0;
};

/// Projectors whose densities, sorted, are further apart than this lie in different layers.
inline constexpr double kLayerRatio = 1.4;

/// At one wall point: the share of each projector, in the order given; they sum to one wherever any of them lights the
/// wall, and to zero elsewhere. `densities` are projector pixels per wall unit.
[[nodiscard]] std::vector<double> blendShares(glm::dvec2 pointInWall, std::span<const ProjectorMapping> projectors,
                                              std::span<const double> densities, const MaskRules& rules);

/// The alpha mask of one projector: its share at the centre of each of its pixels, 65535 = 1. Uses two threads.
[[nodiscard]] devices::Image16 alphaMask(std::size_t projector, std::span<const ProjectorMapping> projectors,
                                         std::span<const double> densities, const MaskRules& rules);

}  // namespace pixelflex::calib
