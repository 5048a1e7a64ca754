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

/// Equation 7 at one wall point: the share of each projector, in the order given; they sum to one wherever any of them
/// lights the wall, and to zero elsewhere. `densities` are projector pixels per wall unit.
[[nodiscard]] std::vector<double> blendShares(glm::dvec2 pointInWall, std::span<const ProjectorMapping> projectors,
                                              std::span<const double> densities, double densityExponent);

/// The alpha mask of one projector: its share at the centre of each of its pixels, 65535 = 1. Uses two threads.
[[nodiscard]] devices::Image16 alphaMask(std::size_t projector, std::span<const ProjectorMapping> projectors,
                                         std::span<const double> densities, double densityExponent);

}  // namespace pixelflex::calib
