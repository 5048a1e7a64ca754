#include "viewer/model/stereo_picture.h"

#include <epoxy/gl.h>

#include "shader_sources.h"
#include "viewer/renderer/textures.h"

namespace pixelflex::viewer {
namespace {

devices::GlProgram makeProgram(devices::GlContext& context) {
  context.makeCurrent();
  return {"stereo", {shaders::kFullscreenVert}, {shaders::kStereoFrag}};
}

}  // namespace

StereoPicture::StereoPicture(devices::GlContext& context, devices::Size size)
    : context_(context),
      size_(size),
      program_(makeProgram(context)),
      picture_(makeTexture(GL_RGBA8, size)),
      target_(devices::GlFramebuffer::create()),
      noVertices_(devices::GlVertexArray::create()) {
  glNamedFramebufferTexture(target_.get(), GL_COLOR_ATTACHMENT0, picture_.get(), 0);
}

StereoPicture::~StereoPicture() {
  try {
    context_.makeCurrent();
  } catch (const devices::DisplayError&) {
    // The context is gone and its objects with it; deleting their names is then without effect.
    return;
  }
}

void StereoPicture::draw(devices::GlName left, devices::GlName right, StereoKind kind) {
  context_.makeCurrent();
  glBindFramebuffer(GL_FRAMEBUFFER, target_.get());
  glViewport(0, 0, size_.width, size_.height);
  glBindVertexArray(noVertices_.get());
  program_.use();
  program_.set("leftEye", 0);
  program_.set("rightEye", 1);
  program_.set("sideBySide", kind == StereoKind::kSideBySide ? 1 : 0);
  glBindTextureUnit(0, left);
  glBindTextureUnit(1, right);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glFinish();  // another context may show it next
}

devices::Image8 StereoPicture::read() {
  context_.makeCurrent();
  devices::Image8 image(size_, 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(picture_.get(), 0, GL_RGB, GL_UNSIGNED_BYTE, static_cast<GLsizei>(image.samples().size_bytes()),
                    image.samples().data());
  return image;
}

}  // namespace pixelflex::viewer
