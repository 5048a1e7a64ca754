#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "tests/reference/reference_warp.h"
#include "viewer/renderer/output_plan.h"
#include "viewer/tiles/frame_belt.h"

namespace pixelflex::testing {

/// Desktop position times weight, and the weight, at a projector position.
using WeightedMap = std::function<glm::dvec3(glm::dvec2 pointInProjector)>;

[[nodiscard]] WeightedMap identityMap(glm::dvec2 shift = {0, 0});
[[nodiscard]] WeightedMap affineMap(devices::Size resolution, devices::Size desktop);
/// Keystone: oblique, about a tenth of the frame lost on one side.
[[nodiscard]] WeightedMap homographyMap(devices::Size resolution, devices::Size desktop);
/// The keystone with barrel distortion on top; only a fine mesh follows it.
[[nodiscard]] WeightedMap bentMap(devices::Size resolution, devices::Size desktop);

/// A grid of columns x rows cells over the projector.
[[nodiscard]] std::vector<reference::Triangle> gridOf(const WeightedMap& map, devices::Size resolution, int columns,
                                                      int rows);

/// The grid cut at the borders of the desktop's tiles.
[[nodiscard]] viewer::WarpMesh meshOf(const std::vector<reference::Triangle>& triangles, devices::Size desktop);

[[nodiscard]] viewer::OutputPlan planOf(const std::string& name, const WeightedMap& map, devices::Size resolution,
                                        devices::Size desktop, int columns, int rows);

/// Deterministic pixels: smooth colour, one-pixel lines and noise.
[[nodiscard]] devices::Image8 testDesktop(devices::Size size, std::uint32_t seed = 1);

/// An update with these boxes of the image; parts outside it are filled with 77.
[[nodiscard]] viewer::Batch batchOf(const devices::Image8& desktop, const std::vector<viewer::Box>& boxes);
[[nodiscard]] viewer::Batch wholeBatch(const devices::Image8& desktop);

}  // namespace pixelflex::testing
