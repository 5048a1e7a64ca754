#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "devices/image/image.h"
#include "viewer/tiles/box.h"

namespace pixelflex::viewer {

/// A corner of the warp mesh. The desktop position carries a projective weight w: the fragment's position is
/// (uw, vw) / w, exact under keystone where affine interpolation is not (calibration reference 2).
struct WarpVertex {
  float x = 0, y = 0;           // projector pixels
  float uw = 0, vw = 0, w = 1;  // desktop pixels times w
  bool operator==(const WarpVertex&) const = default;
};

/// The triangles that read one desktop tile.
struct WarpPatch {
  int layer = 0;  // TileLayout's
  std::uint32_t firstIndex = 0;
  std::uint32_t indexCount = 0;
  bool operator==(const WarpPatch&) const = default;
};

struct WarpMesh {
  std::vector<WarpVertex> vertices;
  std::vector<std::uint32_t> indices;  // three a triangle
  std::vector<WarpPatch> patches;
  bool operator==(const WarpMesh&) const = default;
};

enum class DesktopTransfer { kSrgb, kLinear };
enum class Filter { kCatmullRom, kBilinear, kNearest };
/// What the filter takes means of: the desktop's codes, or their light.
enum class FilterDomain { kSrgb, kLinear };

/// All that the renderer needs to know about one projector: a value, made by the program from the calibration, off the
/// render thread. Linear light x of the desktop (1 is white) becomes alpha * gain * (colour x) + largestBlack * black,
/// held within 0 and 1, before the inverse response.
struct OutputPlan {
  std::string name;
  devices::Size resolution;
  devices::Size desktop;
  WarpMesh mesh;
  glm::mat3 colour{1};
  devices::Image16 alpha;  // one channel of `resolution`, 65535 = 1; empty: 1 everywhere
  devices::Image16 gain;   // one channel of any size, a picture stretched over the frame and linear between the centres
                           // of its pixels, 65535 = 1; empty: 1 everywhere
  devices::Image16 black;  // one channel of `resolution`, 65535 = 1; empty: 0
  glm::vec3 largestBlack{1};                          // light
  std::array<std::vector<float>, 3> inverseResponse;  // per channel: device code 0..1 for light^(1/2.2), evenly spaced;
                                                      // empty: sRGB
  DesktopTransfer transfer = DesktopTransfer::kSrgb;
  Filter filter = Filter::kCatmullRom;  // a mesh that shows the desktop's pixels one to one is not filtered
  FilterDomain filterDomain = FilterDomain::kSrgb;
  bool dither = true;
  /// Set: this output shows desktop pixels one to one from here, bit for bit; mesh, light and response are not used.
  std::optional<glm::ivec2> exactAt;
  /// With it: only these desktop pixels; none: all.
  std::optional<Box> exactShown;
};

}  // namespace pixelflex::viewer
