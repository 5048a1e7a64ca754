#include "viewer/model/model_canvas.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "viewer/renderer/renderer_error.h"
#include "viewer/renderer/textures.h"

namespace pixelflex::viewer {
namespace {

devices::GlTexture sampledTexture(GLenum format, devices::Size size, int samples) {
  if (samples == 1) return makeTexture(format, size);
  auto texture = devices::GlTexture::create(GL_TEXTURE_2D_MULTISAMPLE);
  glTextureStorage2DMultisample(texture.get(), samples, format, size.width, size.height, GL_TRUE);
  return texture;
}

}  // namespace

devices::GlFramebuffer drawingTarget(devices::GlName colour, devices::GlName depth, const std::string& what) {
  auto target = devices::GlFramebuffer::create();
  glNamedFramebufferTexture(target.get(), GL_COLOR_ATTACHMENT0, colour, 0);
  if (depth != 0) glNamedFramebufferTexture(target.get(), GL_DEPTH_ATTACHMENT, depth, 0);
  if (glCheckNamedFramebufferStatus(target.get(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw RendererError("the graphics driver cannot draw into " + what);
  }
  return target;
}

ModelCanvas::ModelCanvas(devices::Size size, int samples, bool measure) : size_(size) {
  const std::string what = fmt::format("{}x{} pixels of {} samples with depth", size.width, size.height, samples);
  const GLenum format = measure ? GL_RGBA32F : GL_RGBA16F;
  depth_ = sampledTexture(GL_DEPTH_COMPONENT32F, size, samples);
  light_ = makeTexture(format, size);
  lightTarget_ = drawingTarget(light_.get(), samples == 1 ? depth_.get() : 0, what);
  if (samples == 1) return;
  samples_ = sampledTexture(format, size, samples);
  sampleTarget_ = drawingTarget(samples_.get(), depth_.get(), what);
}

void ModelCanvas::resolve() const {
  if (!samples_) return;
  const auto [width, height] = size_;
  glBlitNamedFramebuffer(sampleTarget_.get(), lightTarget_.get(), 0, 0, width, height, 0, 0, width, height,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace pixelflex::viewer
