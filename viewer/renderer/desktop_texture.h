#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "devices/display/gl_handle.h"
#include "devices/image/image.h"
#include "viewer/renderer/upload_memory.h"
#include "viewer/renderer/upload_path.h"
#include "viewer/tiles/tile_layout.h"

namespace pixelflex::viewer {

enum class TexelFormat {
  kRgba8,    // codes, not decoded by the sampler
  kRgba32F,  // for measurements: a desktop that holds numbers, such as its own coordinates
};

/// The desktop on the GPU: one array texture with a layer per tile, aprons included, and no second copy anywhere. A
/// layer is cleared to black when it is first used, so that an untouched part of a large desktop costs nothing.
/// Needs its context current for every call.
class DesktopTexture {
 public:
  /// Codes travel in `order`. `memory` may be null, else it must outlive the texture. Throws RendererError when the GPU
  /// cannot hold that many tiles.
  DesktopTexture(devices::Size desktop, TexelFormat format, UploadPath::Order order = UploadPath::Order::kRgba,
                 const UploadMemory* memory = nullptr);

  /// Rows of each box without padding, box after box, in the texture's format. What lies outside the desktop is left
  /// out. Afterwards the pixels may be overwritten: where they lie in the upload memory, the GPU has read them. Throws
  /// RendererError unless `pixels` has exactly the boxes' size.
  void upload(std::span<const Box> boxes, std::span<const std::byte> pixels);

  /// The same of a whole desktop that is in a GL_TEXTURE_2D of this format, row 0 at the top.
  void copy(devices::GlName picture);

  /// Must be called for a layer before a shader reads it: gives a layer that was never uploaded its black.
  void prepare(int layer);

  /// The desktop put together from its tiles, red, green, blue.
  [[nodiscard]] devices::Image8 read();

  [[nodiscard]] const TileLayout& layout() const { return layout_; }
  [[nodiscard]] TexelFormat format() const { return format_; }
  [[nodiscard]] devices::GlName texture() const { return texture_.get(); }
  /// Since the texture was made, aprons included.
  [[nodiscard]] std::uint64_t bytesUploaded() const { return bytesUploaded_; }

 private:
  [[nodiscard]] std::size_t bytesPerTexel() const { return format_ == TexelFormat::kRgba8 ? 4 : 16; }
  void allocate();
  void setOrder(UploadPath::Order order);
  /// `rows` is an offset into the buffer where one is bound.
  void uploadBox(const Box& box, const std::byte* rows);

  TileLayout layout_;
  TexelFormat format_;
  UploadPath::Order order_ = UploadPath::Order::kRgba;
  const UploadMemory* memory_;
  devices::GlTexture texture_;
  std::vector<bool> prepared_;  // per layer
  std::uint64_t bytesUploaded_ = 0;
};

}  // namespace pixelflex::viewer
