#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "viewer/tiles/box.h"

namespace pixelflex::viewer {

/// A tile's texture is at most this wide and high, apron included (report 6.1).
inline constexpr int kTileExtent = 1024;
/// Texels of its neighbours that a tile repeats on each side, so that a 4x4 filter never leaves its tile.
inline constexpr int kTileApron = 2;
/// Desktop pixels from one tile to the next: the patch of the desktop that a tile alone answers for.
inline constexpr int kTileStride = kTileExtent - 2 * kTileApron;

/// A part of a damaged box that lies in one tile's texture (apron included).
struct TilePart {
  int layer = 0;
  Box inDesktop;
  glm::ivec2 texel{0, 0};  // where inDesktop's top-left pixel goes in the tile's texture
  bool operator==(const TilePart&) const = default;
};

/// How a desktop is cut into tiles, row by row. Tile (i, j) answers for desktop pixels [i*stride, (i+1)*stride) x
/// [j*stride, (j+1)*stride) and its texel (a, b) holds desktop pixel (i*stride - apron + a, j*stride - apron + b).
class TileLayout {
 public:
  TileLayout() = default;
  explicit TileLayout(devices::Size desktop);

  [[nodiscard]] devices::Size desktop() const { return desktop_; }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int count() const { return columns_ * rows_; }
  /// The desktop pixels that the tile answers for, clipped to the desktop.
  [[nodiscard]] Box patch(int layer) const;
  /// Everything in a tile's texture, apron included, clipped to the desktop.
  [[nodiscard]] Box coverage(int layer) const;
  /// The desktop position of the texture's texel corner (0, 0).
  [[nodiscard]] glm::ivec2 origin(int layer) const;
  /// The damaged box, cut by tile: every tile whose texture holds some of it appears once.
  [[nodiscard]] std::vector<TilePart> cut(const Box& damaged) const;

 private:
  devices::Size desktop_;
  int columns_ = 0;
  int rows_ = 0;
};

}  // namespace pixelflex::viewer
