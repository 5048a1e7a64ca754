#pragma once

#include "devices/display/gl_context.h"
#include "devices/display/gl_handle.h"
#include "devices/display/gl_program.h"
#include "devices/image/image.h"

namespace pixelflex::viewer {

/// How both eyes' pictures are shown on an ordinary screen: the halves squeezed, or red for the left eye and green and
/// blue for the right.
enum class StereoKind { kOff, kSideBySide, kAnaglyph };

/// Both eyes' pictures as one. One thread, the context's, which must outlive it; each function makes it current.
class StereoPicture {
 public:
  StereoPicture(devices::GlContext& context, devices::Size size);
  ~StereoPicture();
  StereoPicture(const StereoPicture&) = delete;
  StereoPicture& operator=(const StereoPicture&) = delete;

  /// Both GL_TEXTURE_2D of the size given.
  void draw(devices::GlName left, devices::GlName right, StereoKind kind);

  /// GL_TEXTURE_2D, row 0 at the top.
  [[nodiscard]] devices::GlName texture() const { return picture_.get(); }
  [[nodiscard]] devices::Image8 read();

 private:
  devices::GlContext& context_;
  devices::Size size_;
  devices::GlProgram program_;
  devices::GlTexture picture_;
  devices::GlFramebuffer target_;
  devices::GlVertexArray noVertices_;
};

}  // namespace pixelflex::viewer
