#include "viewer/model/picture_texture.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "viewer/renderer/renderer_error.h"

namespace pixelflex::viewer {
namespace {

double lightOf(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

double codeOf(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

void weight(devices::Image8& picture) {
  std::array<double, 256> light{};
  for (std::size_t i = 0; i < light.size(); ++i) light[i] = lightOf(static_cast<double>(i) / 255);
  const auto samples = picture.samples();
  for (std::size_t i = 0; i + 3 < samples.size(); i += 4) {
    const int share = samples[i + 3];
    if (share == 255) continue;
    for (std::size_t c = i; c < i + 3; ++c) {
      const double code = share == 0 ? 0 : codeOf(light[samples[c]] * share / 255);
      samples[c] = static_cast<std::uint8_t>(std::lround(255 * code));
    }
  }
}

}  // namespace

devices::GlTexture pictureTexture(devices::Image8 picture, bool weighted) {
  const bool four = picture.channels() == 4;
  if (four && weighted) weight(picture);
  while (glGetError() != GL_NO_ERROR) continue;  // an old error must not be taken for this picture's
  auto texture = devices::GlTexture::create(GL_TEXTURE_2D);
  const auto longest = static_cast<unsigned>(std::max(picture.width(), picture.height()));
  const auto levels = static_cast<GLsizei>(std::bit_width(longest));
  glTextureStorage2D(texture.get(), levels, GL_SRGB8_ALPHA8, picture.width(), picture.height());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.get(), 0, 0, 0, picture.width(), picture.height(), four ? GL_RGBA : GL_RGB,
                      GL_UNSIGNED_BYTE, picture.samples().data());
  glGenerateTextureMipmap(texture.get());
  if (glGetError() != GL_NO_ERROR) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    throw RendererError(
        fmt::format("the graphics card does not take the model's picture of {}x{} pixels: it has too little memory, or "
                    "a side is longer than {}",
                    picture.width(), picture.height(), most));
  }
  glTextureParameteri(texture.get(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(texture.get(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

}  // namespace pixelflex::viewer
