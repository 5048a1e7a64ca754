#include "viewer/vnc/update_publisher.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "viewer/tiles/batch_writer.h"

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kBytesPerPixel = 4;

void appendRows(const FrameView& frame, const Box& rows, PixelBytes& pixels) {
  const std::size_t rowBytes = static_cast<std::size_t>(rows.width()) * kBytesPerPixel;
  for (int y = rows.top; y < rows.bottom; ++y) {
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.size.width) + static_cast<std::size_t>(rows.left);
    const auto row = frame.pixels.subspan(pixel * kBytesPerPixel, rowBytes);
    pixels.insert(pixels.end(), row.begin(), row.end());
  }
}

}  // namespace

bool publishUpdate(const FrameView& frame, const Update& update, FrameBelt& belt, const std::stop_token& stop) {
  if (update.damage.empty()) return true;
  const BatchWriter::Header header{.update = update.serial,
                                   .received = update.received,
                                   .decoding = update.decoding,
                                   .desktop = frame.size,
                                   .bytes = static_cast<std::size_t>(update.damage.area()) * kBytesPerPixel};
  BatchWriter writer(header, belt, stop, [&frame](const Box& rows, PixelBytes& pixels) {
    assert(boxOf(frame.size).contains(rows));
    appendRows(frame, rows, pixels);
  });
  if (!std::ranges::all_of(update.damage.boxes(), [&writer](const Box& box) { return writer.add(box); })) return false;
  writer.finish();
  return true;
}

}  // namespace pixelflex::viewer
