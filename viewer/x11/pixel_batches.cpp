#include "viewer/x11/pixel_batches.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kBytesPerPixel = 4;

static_assert(std::endian::native == std::endian::little, "a batch's pixels begin with their red byte");

void appendPixels(std::span<const std::byte> from, const PixelLayout& layout, std::vector<std::byte>& to) {
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

// Fills batch after batch; every batch but the last leaves when the next row does not fit into it.
class Packer {
 public:
  Packer(const PackedUpdate& update, FrameBelt& belt, const std::stop_token& stop)
      : update_(update), belt_(belt), stop_(stop), left_(update.pixels) {}

  bool add(Box box) {
    const std::size_t rowBytes = static_cast<std::size_t>(box.width()) * kBytesPerPixel;
    while (!box.empty()) {
      const std::size_t room = batch_ == nullptr ? 0 : FrameBelt::kMaxBytes - batch_->pixels.size();
      const int rows = static_cast<int>(std::min<std::size_t>(room / rowBytes, static_cast<std::size_t>(box.height())));
      if (rows == 0) {
        if (!startBatch()) return false;
        continue;
      }
      const std::size_t bytes = rowBytes * static_cast<std::size_t>(rows);
      appendPixels(left_.first(bytes), update_.layout, batch_->pixels);
      left_ = left_.subspan(bytes);
      batch_->boxes.push_back({box.left, box.top, box.right, box.top + rows});
      box.top += rows;
    }
    return true;
  }

  void finish() {
    assert(batch_ != nullptr);
    batch_->completesUpdate = true;
    belt_.publish(batch_);
  }

 private:
  bool startBatch() {
    if (batch_ != nullptr) belt_.publish(batch_);
    batch_ = belt_.acquire(stop_);
    if (batch_ == nullptr) return false;
    batch_->update = update_.serial;
    batch_->received = update_.received;
    batch_->desktop = update_.desktop;
    batch_->pixels.reserve(std::min(left_.size(), FrameBelt::kMaxBytes));
    return true;
  }

  const PackedUpdate& update_;
  FrameBelt& belt_;
  const std::stop_token& stop_;
  std::span<const std::byte> left_;
  Batch* batch_ = nullptr;
};

}  // namespace

bool publishPacked(const PackedUpdate& update, FrameBelt& belt, const std::stop_token& stop) {
  static_assert(kBytesPerPixel * 65536 <= FrameBelt::kMaxBytes, "a row must fit into a batch");
  assert(update.pixels.size() == static_cast<std::size_t>(update.damage.area()) * kBytesPerPixel);
  Packer packer(update, belt, stop);
  for (const Box& box : update.damage.boxes()) {
    if (!packer.add(box)) return false;
  }
  packer.finish();
  return true;
}

}  // namespace pixelflex::viewer
