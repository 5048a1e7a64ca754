#include "viewer/plan/scaled_screen.h"

#include <algorithm>
#include <glm/common.hpp>

namespace pixelflex::viewer {
namespace {

// Of the rectangles, desktop pixels: a little damage draws a little of the screen.
constexpr int kCell = 128;

struct Rectangle {
  glm::dvec2 low{0, 0}, high{0, 0};
};

class Builder {
 public:
  Builder(const Placement& placement, glm::ivec2 screenAt, devices::Size screen)
      : placement_(placement), screenAt_(screenAt), screen_(screen.width, screen.height) {}

  void addPatch(int layer, const Box& patch) {
    const auto first = static_cast<std::uint32_t>(mesh_.indices.size());
    for (int top = patch.top; top < patch.bottom; top += kCell) {
      for (int left = patch.left; left < patch.right; left += kCell) {
        addCell({left, top, std::min(left + kCell, patch.right), std::min(top + kCell, patch.bottom)});
      }
    }
    const auto count = static_cast<std::uint32_t>(mesh_.indices.size()) - first;
    if (count > 0) mesh_.patches.push_back({layer, first, count});
  }
  [[nodiscard]] WarpMesh take() { return std::move(mesh_); }

 private:
  void addCell(const Box& cell) {
    const Rectangle onScreen{glm::max(screenFrom({cell.left, cell.top}), glm::dvec2(0)),
                             glm::min(screenFrom({cell.right, cell.bottom}), screen_)};
    if (onScreen.low.x >= onScreen.high.x || onScreen.low.y >= onScreen.high.y) return;
    const auto corner = static_cast<std::uint32_t>(mesh_.vertices.size());
    addVertex(onScreen.low);
    addVertex({onScreen.high.x, onScreen.low.y});
    addVertex(onScreen.high);
    addVertex({onScreen.low.x, onScreen.high.y});
    for (const std::uint32_t index : {0U, 1U, 2U, 0U, 2U, 3U}) mesh_.indices.push_back(corner + index);
  }

  [[nodiscard]] glm::dvec2 screenFrom(glm::dvec2 inDesktop) const {
    return placement_.wallFromDesktop(inDesktop) - screenAt_;
  }

  void addVertex(glm::dvec2 onScreen) {
    const glm::vec2 inDesktop(placement_.desktopFromWall(onScreen + screenAt_));
    mesh_.vertices.push_back(
        {static_cast<float>(onScreen.x), static_cast<float>(onScreen.y), inDesktop.x, inDesktop.y, 1});
  }

  const Placement& placement_;
  glm::dvec2 screenAt_;
  glm::dvec2 screen_;
  WarpMesh mesh_;
};

}  // namespace

WarpMesh scaledScreen(const TileLayout& layout, const Placement& placement, glm::ivec2 screenAt, devices::Size screen) {
  Builder builder(placement, screenAt, screen);
  for (int layer = 0; layer < layout.count(); ++layer) {
    const Box patch = intersect(layout.patch(layer), placement.shown);
    if (!patch.empty()) builder.addPatch(layer, patch);
  }
  return builder.take();
}

}  // namespace pixelflex::viewer
