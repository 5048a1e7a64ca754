#include "viewer/plan/overview.h"

#include <algorithm>
#include <cmath>

#include "viewer/tiles/tile_layout.h"

namespace pixelflex::viewer {
namespace {

devices::Size scaled(devices::Size desktop) {
  constexpr double kWidest = 1600;
  constexpr double kHighest = 1000;
  const double scale = std::min({1.0, kWidest / desktop.width, kHighest / desktop.height});
  const auto pixels = [scale](int extent) { return std::max(1, static_cast<int>(std::lround(extent * scale))); };
  return {pixels(desktop.width), pixels(desktop.height)};
}

}  // namespace

OutputPlan overviewOf(devices::Size desktop) {
  OutputPlan plan;
  plan.name = "control";
  plan.resolution = scaled(desktop);
  plan.desktop = desktop;
  plan.filter = Filter::kBilinear;
  plan.dither = false;
  const TileLayout layout(desktop);
  const glm::dvec2 scale{1.0 * plan.resolution.width / desktop.width, 1.0 * plan.resolution.height / desktop.height};
  for (int layer = 0; layer < layout.count(); ++layer) {
    const Box tile = layout.patch(layer);
    const auto first = static_cast<std::uint32_t>(plan.mesh.vertices.size());
    for (const int y : {tile.top, tile.bottom}) {
      for (const int x : {tile.left, tile.right}) {
        plan.mesh.vertices.push_back({.x = static_cast<float>(x * scale.x),
                                      .y = static_cast<float>(y * scale.y),
                                      .uw = static_cast<float>(x),
                                      .vw = static_cast<float>(y)});
      }
    }
    plan.mesh.patches.push_back({layer, static_cast<std::uint32_t>(plan.mesh.indices.size()), 6});
    for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U}) plan.mesh.indices.push_back(first + corner);
  }
  return plan;
}

}  // namespace pixelflex::viewer
