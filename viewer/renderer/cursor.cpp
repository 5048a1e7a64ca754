#include "viewer/renderer/cursor.h"

#include <epoxy/gl.h>

#include <cstdint>

#include "viewer/renderer/renderer_error.h"

namespace pixelflex::viewer {
namespace {

devices::Image8 multipliedByAlpha(devices::Image8 image) {
  auto samples = image.samples();
  for (std::size_t i = 0; i + 3 < samples.size(); i += 4) {
    const unsigned alpha = samples[i + 3];
    for (std::size_t c = 0; c < 3; ++c)
      samples[i + c] = static_cast<std::uint8_t>((samples[i + c] * alpha + 127) / 255);
  }
  return image;
}

}  // namespace

void Cursor::setImage(const devices::Image8& image, glm::ivec2 hotspot) {
  texture_.reset();
  size_ = image.size();
  hotspot_ = hotspot;
  if (image.empty()) return;
  if (image.channels() != 4) throw RendererError("a cursor's image needs red, green, blue and alpha");
  const auto pixels = multipliedByAlpha(image);
  texture_ = devices::GlTexture::create(GL_TEXTURE_2D);
  glTextureStorage2D(texture_.get(), 1, GL_RGBA8, size_.width, size_.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture_.get(), 0, 0, 0, size_.width, size_.height, GL_RGBA, GL_UNSIGNED_BYTE,
                      pixels.samples().data());
}

Box Cursor::box() const {
  if (!shown_ || !texture_) return {};
  const auto corner = topLeft();
  return {corner.x, corner.y, corner.x + size_.width, corner.y + size_.height};
}

}  // namespace pixelflex::viewer
