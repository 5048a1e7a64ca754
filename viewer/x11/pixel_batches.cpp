#include "viewer/x11/pixel_batches.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <vector>

#include "viewer/tiles/batch_writer.h"

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kBytesPerPixel = 4;

static_assert(std::endian::native == std::endian::little, "a batch's pixels begin with their red byte");

void appendPixels(std::span<const std::byte> from, const PixelLayout& layout, PixelBytes& to) {
  const std::size_t begin = to.size();
  to.resize(begin + from.size());
  for (std::size_t i = 0; i < from.size(); i += kBytesPerPixel) {
    std::uint32_t pixel = 0;
    std::memcpy(&pixel, from.data() + i, kBytesPerPixel);
    const std::uint32_t rgb = (pixel >> layout.redShift & 0xff) | (pixel >> layout.greenShift & 0xff) << 8 |
                              (pixel >> layout.blueShift & 0xff) << 16;
    std::memcpy(to.data() + begin + i, &rgb, kBytesPerPixel);
  }
}

}  // namespace

bool publishPacked(const PackedUpdate& update, FrameBelt& belt, const std::stop_token& stop) {
  assert(update.pixels.size() == static_cast<std::size_t>(update.damage.area()) * kBytesPerPixel);
  const BatchWriter::Header header{.update = update.serial,
                                   .received = update.received,
                                   .decoding = update.decoding,
                                   .desktop = update.desktop,
                                   .bytes = update.pixels.size()};
  std::span<const std::byte> left = update.pixels;
  BatchWriter writer(header, belt, stop, [&](const Box& rows, PixelBytes& pixels) {
    const std::size_t bytes = static_cast<std::size_t>(rows.area()) * kBytesPerPixel;
    appendPixels(left.first(bytes), update.layout, pixels);
    left = left.subspan(bytes);
  });
  if (!std::ranges::all_of(update.damage.boxes(), [&writer](const Box& box) { return writer.add(box); })) return false;
  writer.finish();
  return true;
}

}  // namespace pixelflex::viewer
