#include "devices/display/gl_handle.h"

#include <epoxy/gl.h>

namespace pixelflex::devices {

GlName TextureKind::create(std::uint32_t target) {
  GlName name = 0;
  glCreateTextures(target, 1, &name);
  return name;
}
void TextureKind::destroy(GlName name) {
  glDeleteTextures(1, &name);
}

GlName BufferKind::create() {
  GlName name = 0;
  glCreateBuffers(1, &name);
  return name;
}
void BufferKind::destroy(GlName name) {
  glDeleteBuffers(1, &name);
}

GlName FramebufferKind::create() {
  GlName name = 0;
  glCreateFramebuffers(1, &name);
  return name;
}
void FramebufferKind::destroy(GlName name) {
  glDeleteFramebuffers(1, &name);
}

GlName VertexArrayKind::create() {
  GlName name = 0;
  glCreateVertexArrays(1, &name);
  return name;
}
void VertexArrayKind::destroy(GlName name) {
  glDeleteVertexArrays(1, &name);
}

GlName ShaderKind::create(std::uint32_t stage) {
  return glCreateShader(stage);
}
void ShaderKind::destroy(GlName name) {
  glDeleteShader(name);
}

GlName ProgramKind::create() {
  return glCreateProgram();
}
void ProgramKind::destroy(GlName name) {
  glDeleteProgram(name);
}

}  // namespace pixelflex::devices
