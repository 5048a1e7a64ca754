#pragma once

#include <glm/vec2.hpp>

#include "devices/image/image.h"
#include "viewer/programs/view_options.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::viewer {

/// A sign for "no connection": a disc with an exclamation mark, four channels, `extent` pixels each way.
[[nodiscard]] devices::Image8 lostSign(int extent);

/// A pointer's image inside a ring that is seen from afar, `extent` pixels each way; the hot spot is in the middle.
[[nodiscard]] devices::Image8 ringAround(const devices::Image8& cursor, glm::ivec2 hotspot, int extent);

/// What the wall shows of a lost connection: the picture dimmed, or a sign in the pointer's stead, which is of no use
/// meanwhile. The pointer goes through here because of that. Render thread.
class LostPicture {
 public:
  /// `renderer` must outlive this.
  LostPicture(WallRenderer& renderer, WhenLost whenLost) : renderer_(renderer), whenLost_(whenLost) {}

  /// See WallRenderer. With a sign shown they take effect when it goes.
  void setCursor(devices::Image8 image, glm::ivec2 hotspot);
  void moveCursor(glm::ivec2 position);

  /// Shows a ring around the pointer, of a size that fits the desktop, or takes it away.
  void ring(devices::Size desktop);
  void unring();

  /// `desktop` is the size of what is shown, empty if nothing is yet.
  void lose(devices::Size desktop);
  void comeBack();

 private:
  void putSign(devices::Size desktop);
  void putCursor();

  WallRenderer& renderer_;
  WhenLost whenLost_;
  bool signShown_ = false;
  int ringExtent_ = 0;  // 0: no ring
  devices::Image8 cursor_;
  glm::ivec2 hotspot_{0, 0};
  glm::ivec2 position_{0, 0};
};

}  // namespace pixelflex::viewer
