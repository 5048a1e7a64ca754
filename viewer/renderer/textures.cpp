#include "viewer/renderer/textures.h"

#include <epoxy/gl.h>

namespace pixelflex::viewer {

devices::GlTexture makeTexture(std::uint32_t format, devices::Size size) {
  auto texture = devices::GlTexture::create(GL_TEXTURE_2D);
  glTextureStorage2D(texture.get(), 1, format, size.width, size.height);
  glTextureParameteri(texture.get(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.get(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

}  // namespace pixelflex::viewer
