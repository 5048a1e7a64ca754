#pragma once

#include <string>

#include "devices/display/gl_handle.h"
#include "devices/image/size.h"

namespace pixelflex::viewer {

/// A framebuffer of a colour texture and perhaps (not 0) one of depth. Throws RendererError, which names `what`, when
/// the driver cannot draw into them.
[[nodiscard]] devices::GlFramebuffer drawingTarget(devices::GlName colour, devices::GlName depth,
                                                   const std::string& what);

/// What frames of one size are drawn in, one after the other: light with depth, of several samples for each pixel or
/// one. Needs its context current.
class ModelCanvas {
 public:
  /// `measure`: in 32 bits, else 16. Throws RendererError.
  ModelCanvas(devices::Size size, int samples, bool measure);

  /// The scene goes here,
  [[nodiscard]] devices::GlName sampleTarget() const { return samples_ ? sampleTarget_.get() : lightTarget_.get(); }
  /// its samples become pixels,
  void resolve() const;
  /// and what comes after it goes here.
  [[nodiscard]] devices::GlName lightTarget() const { return lightTarget_.get(); }
  /// GL_TEXTURE_2D.
  [[nodiscard]] devices::GlName light() const { return light_.get(); }

 private:
  devices::Size size_;
  devices::GlTexture samples_;  // where a pixel has several
  devices::GlTexture depth_;
  devices::GlTexture light_;
  devices::GlFramebuffer sampleTarget_;
  devices::GlFramebuffer lightTarget_;
};

}  // namespace pixelflex::viewer
