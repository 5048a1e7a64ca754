#include "viewer/tiles/tile_layout.h"

#include <cassert>
#include <stdexcept>

namespace pixelflex::viewer {
namespace {

// A run of tiles along one axis: [first, end).
struct TileRun {
  int first = 0;
  int end = 0;
};

// The tiles of `count` along an axis whose textures, aprons included, hold some of desktop pixels [from, to). `to` > 0.
TileRun tilesHolding(int from, int to, int count) {
  const int beforeFirst = from + kTileApron - kTileExtent;  // the last texel of a tile that ends just short of `from`
  const int first = beforeFirst < 0 ? 0 : beforeFirst / kTileStride + 1;
  const int last = (to - 1 + kTileApron) / kTileStride;
  return {first, std::min(last + 1, count)};
}

}  // namespace

TileLayout::TileLayout(devices::Size desktop)
    : desktop_(desktop),
      columns_((desktop.width + kTileStride - 1) / kTileStride),
      rows_((desktop.height + kTileStride - 1) / kTileStride) {
  if (desktop.width <= 0 || desktop.height <= 0) throw std::invalid_argument("a desktop needs a positive extent");
}

glm::ivec2 TileLayout::origin(int layer) const {
  assert(layer >= 0 && layer < count());
  return {layer % columns_ * kTileStride - kTileApron, layer / columns_ * kTileStride - kTileApron};
}

Box TileLayout::patch(int layer) const {
  const glm::ivec2 corner = origin(layer) + kTileApron;
  return intersect({corner.x, corner.y, corner.x + kTileStride, corner.y + kTileStride}, boxOf(desktop_));
}

Box TileLayout::coverage(int layer) const {
  const glm::ivec2 corner = origin(layer);
  return intersect({corner.x, corner.y, corner.x + kTileExtent, corner.y + kTileExtent}, boxOf(desktop_));
}

std::vector<TilePart> TileLayout::cut(const Box& damaged) const {
  const Box box = intersect(damaged, boxOf(desktop_));
  if (box.empty()) return {};
  const TileRun across = tilesHolding(box.left, box.right, columns_);
  const TileRun down = tilesHolding(box.top, box.bottom, rows_);
  std::vector<TilePart> parts;
  for (int j = down.first; j < down.end; ++j) {
    for (int i = across.first; i < across.end; ++i) {
      const int layer = j * columns_ + i;
      const Box inDesktop = intersect(box, coverage(layer));
      parts.push_back({layer, inDesktop, glm::ivec2(inDesktop.left, inDesktop.top) - origin(layer)});
    }
  }
  return parts;
}

}  // namespace pixelflex::viewer
