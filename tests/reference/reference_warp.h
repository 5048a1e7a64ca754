#pragma once

#include <array>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "devices/image/image.h"

namespace pixelflex::reference {

/// Where on the desktop a projector position looks, in pixels; none outside the picture.
using InverseMap = std::function<std::optional<glm::dvec2>(glm::dvec2 pointInProjector)>;

enum class Kernel { kCubic, kLinear, kNearest };

/// The same job as the renderer's, for one projector, described from the other end: for each pixel its desktop
/// position, an untiled desktop, everything in double.
struct Job {
  devices::Size resolution;
  InverseMap desktopFromProjector;
  Kernel kernel = Kernel::kCubic;
  bool linearDesktop = false;
  bool filterLight = false;                                     // the kernel's means are of light
  std::array<double, 9> colour{1, 0, 0, 0, 1, 0, 0, 0, 1};      // row major
  std::function<double(int x, int y)> alpha;                    // empty: 1
  devices::Image16 gain;                                        // stretched over the frame, 65535 = 1; empty: 1
  std::function<glm::dvec3(int x, int y)> black;                // light; empty: 0
  std::function<double(double light, int channel)> deviceCode;  // 0..1 for light; empty: sRGB
  double highestCode = 255;
};

/// Device values 0..highestCode, not rounded; fourth channel 1 where the picture is.
[[nodiscard]] devices::Image<double> warp(const devices::Image8& desktop, const Job& job);

/// A desktop value at a position, clamped at the border, 0..1, before clipping: a code, or light.
[[nodiscard]] double sample(const devices::Image8& desktop, glm::dvec2 position, int channel, Kernel kernel,
                            bool inLight = false);

/// A triangle of projector positions with desktop positions times weight.
struct Triangle {
  std::array<glm::dvec2, 3> inProjector;
  std::array<glm::dvec3, 3> weighted;  // u*w, v*w, w
};

/// Piecewise map by search and barycentric coordinates.
[[nodiscard]] InverseMap mapOfTriangles(std::vector<Triangle> triangles, devices::Size desktop);

}  // namespace pixelflex::reference
