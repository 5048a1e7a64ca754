#include "viewer/renderer/desktop_texture.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "viewer/renderer/renderer_error.h"

namespace pixelflex::viewer {
namespace {

std::size_t areaOf(const Box& box) {
  return static_cast<std::size_t>(box.area());
}

GLenum channelsOf(UploadPath::Order order) {
  return order == UploadPath::Order::kBgra ? GL_BGRA : GL_RGBA;
}

/// Until the GPU has done what it was told. A driver that reads from a buffer does so when it likes.
void waitForGpu() {
  const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  constexpr GLuint64 kSecond = 1'000'000'000;
  while (glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, kSecond) == GL_TIMEOUT_EXPIRED) continue;
  glDeleteSync(fence);
}

GLenum texelType(TexelFormat format) {
  return format == TexelFormat::kRgba8 ? GL_UNSIGNED_BYTE : GL_FLOAT;
}

}  // namespace

DesktopTexture::DesktopTexture(devices::Size desktop, TexelFormat format, UploadPath::Order order,
                               const UploadMemory* memory)
    : layout_(desktop),
      format_(format),
      memory_(memory),
      texture_(devices::GlTexture::create(GL_TEXTURE_2D_ARRAY)),
      prepared_(static_cast<std::size_t>(layout_.count()), false) {
  allocate();
  glTextureParameteri(texture_.get(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture_.get(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  setOrder(order);
}

void DesktopTexture::setOrder(UploadPath::Order order) {
  order_ = order;
  const bool exchanged = order == UploadPath::Order::kBgra;
  glTextureParameteri(texture_.get(), GL_TEXTURE_SWIZZLE_R, exchanged ? GL_BLUE : GL_RED);
  glTextureParameteri(texture_.get(), GL_TEXTURE_SWIZZLE_B, exchanged ? GL_RED : GL_BLUE);
}

void DesktopTexture::allocate() {
  const auto desktop = layout_.desktop();
  GLint layers = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
  while (glGetError() != GL_NO_ERROR) continue;  // an old error must not be taken for this allocation's
  const auto internal = format_ == TexelFormat::kRgba8 ? GL_RGBA8 : GL_RGBA32F;
  if (layout_.count() <= layers) {
    glTextureStorage3D(texture_.get(), 1, static_cast<GLenum>(internal),
                       std::min(kTileExtent, desktop.width + 2 * kTileApron),
                       std::min(kTileExtent, desktop.height + 2 * kTileApron), layout_.count());
  }
  if (layout_.count() > layers || glGetError() != GL_NO_ERROR) {
    throw RendererError(
        fmt::format("a desktop of {}x{} needs {} tiles ({} MiB), more than this graphics driver holds; "
                    "use a smaller desktop",
                    desktop.width, desktop.height, layout_.count(),
                    std::size_t{4} * bytesPerTexel() / 4 * static_cast<std::size_t>(layout_.count())));
  }
}

void DesktopTexture::upload(std::span<const Box> boxes, std::span<const std::byte> pixels) {
  std::size_t expected = 0;
  for (const auto& box : boxes) expected += areaOf(box) * bytesPerTexel();
  if (expected != pixels.size()) {
    throw RendererError(fmt::format("an update brings {} bytes for boxes of {} bytes", pixels.size(), expected));
  }
  const auto mapped = memory_ == nullptr ? std::nullopt : memory_->offsetOf(pixels.data());
  if (mapped) glBindBuffer(GL_PIXEL_UNPACK_BUFFER, memory_->buffer());
  // With a buffer bound GL takes the offset into it for an address.
  const std::byte* rows = mapped ? reinterpret_cast<const std::byte*>(*mapped) : pixels.data();  // NOLINT
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (const auto& box : boxes) {
    if (!box.empty()) uploadBox(box, rows);
    rows += areaOf(box) * bytesPerTexel();
  }
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  if (!mapped) return;
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  waitForGpu();
}

void DesktopTexture::uploadBox(const Box& box, const std::byte* rows) {
  const auto inside = intersect(box, boxOf(layout_.desktop()));
  glPixelStorei(GL_UNPACK_ROW_LENGTH, box.width());
  for (const auto& part : layout_.cut(inside)) {
    const auto& from = part.inDesktop;
    if (from != layout_.coverage(part.layer)) prepare(part.layer);
    prepared_[static_cast<std::size_t>(part.layer)] = true;
    const auto skipped = std::int64_t{from.top - box.top} * box.width() + (from.left - box.left);
    glTextureSubImage3D(texture_.get(), 0, part.texel.x, part.texel.y, part.layer, from.width(), from.height(), 1,
                        channelsOf(order_), texelType(format_),
                        rows + static_cast<std::size_t>(skipped) * bytesPerTexel());
    bytesUploaded_ += areaOf(from) * bytesPerTexel();
  }
}

void DesktopTexture::copy(devices::GlName picture) {
  setOrder(UploadPath::Order::kRgba);  // texels are copied as they are, and all of them
  for (const auto& part : layout_.cut(boxOf(layout_.desktop()))) {
    const auto& from = part.inDesktop;
    if (from != layout_.coverage(part.layer)) prepare(part.layer);
    prepared_[static_cast<std::size_t>(part.layer)] = true;
    glCopyImageSubData(picture, GL_TEXTURE_2D, 0, from.left, from.top, 0, texture_.get(), GL_TEXTURE_2D_ARRAY, 0,
                       part.texel.x, part.texel.y, part.layer, from.width(), from.height(), 1);
  }
}

void DesktopTexture::prepare(int layer) {
  const auto index = static_cast<std::size_t>(layer);
  if (prepared_[index]) return;
  prepared_[index] = true;
  GLint width = 0;
  GLint height = 0;
  glGetTextureLevelParameteriv(texture_.get(), 0, GL_TEXTURE_WIDTH, &width);
  glGetTextureLevelParameteriv(texture_.get(), 0, GL_TEXTURE_HEIGHT, &height);
  glClearTexSubImage(texture_.get(), 0, 0, 0, layer, width, height, 1, GL_RGBA, texelType(format_), nullptr);
}

devices::Image8 DesktopTexture::read() {
  devices::Image8 image(layout_.desktop(), 3);
  std::vector<std::uint8_t> tile;
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  for (int layer = 0; layer < layout_.count(); ++layer) {
    prepare(layer);
    const auto patch = layout_.patch(layer);
    const auto origin = layout_.origin(layer);
    tile.resize(areaOf(patch) * 4);
    glGetTextureSubImage(texture_.get(), 0, patch.left - origin.x, patch.top - origin.y, layer, patch.width(),
                         patch.height(), 1, channelsOf(order_), GL_UNSIGNED_BYTE, static_cast<GLsizei>(tile.size()),
                         tile.data());
    const auto* texel = tile.data();
    for (int y = patch.top; y < patch.bottom; ++y) {
      for (int x = patch.left; x < patch.right; ++x, texel += 4) std::copy_n(texel, 3, &image.at(x, y));
    }
  }
  return image;
}

}  // namespace pixelflex::viewer
