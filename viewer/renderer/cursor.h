#pragma once

#include <glm/vec2.hpp>

#include "devices/display/gl_handle.h"
#include "devices/image/image.h"
#include "viewer/tiles/box.h"

namespace pixelflex::viewer {

/// The pointer's image on the GPU and its place on the desktop.
class Cursor {
 public:
  /// `image` has four channels, colours not multiplied by alpha; an empty image hides the pointer. `hotspot` is the
  /// image's pixel that points.
  void setImage(const devices::Image8& image, glm::ivec2 hotspot);
  /// The desktop pixel pointed at.
  void moveTo(glm::ivec2 position) { position_ = position; }
  void show(bool shown) { shown_ = shown; }

  /// Desktop pixels covered, empty when hidden.
  [[nodiscard]] Box box() const;
  [[nodiscard]] devices::GlName texture() const { return texture_.get(); }
  /// Desktop pixel of the image's top-left corner.
  [[nodiscard]] glm::ivec2 topLeft() const { return position_ - hotspot_; }

 private:
  devices::GlTexture texture_;
  devices::Size size_;
  glm::ivec2 hotspot_{0, 0};
  glm::ivec2 position_{0, 0};
  bool shown_ = true;
};

}  // namespace pixelflex::viewer
