#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "devices/image/image.h"

namespace pixelflex::devices {

/// How cameras lay out what they send.
enum class RawLayout { kGrey8, kGrey16, kRgb8, kBgr8, kYuyv, kUyvy, kBayerRg8, kBayerGr8, kBayerGb8, kBayerBg8 };

struct RawPicture {
  RawLayout layout = RawLayout::kGrey8;
  Size size;
  std::size_t stride = 0;  // bytes from row to row; 0: rows without gaps
  int bits = 16;           // kGrey16, little-endian: of which so many are used, the low ones
  std::span<const std::uint8_t> bytes;
};

/// Three channels of eight bits. Codes stay as the camera made them: nothing is balanced or stretched; YUV is BT.601 of
/// limited range, as V4L2 has it. Bayer mosaics become means of the nearest samples of each colour. Throws
/// std::runtime_error when there are fewer bytes than the picture needs.
[[nodiscard]] Image8 developed(const RawPicture& raw);

}  // namespace pixelflex::devices
