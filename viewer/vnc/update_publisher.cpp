#include "viewer/vnc/update_publisher.h"

#include <algorithm>
#include <cassert>

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kBytesPerPixel = 4;

void appendRows(const FrameView& frame, const Box& box, Batch& batch) {
  const std::size_t rowBytes = static_cast<std::size_t>(box.width()) * kBytesPerPixel;
  for (int y = box.top; y < box.bottom; ++y) {
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.size.width) + static_cast<std::size_t>(box.left);
    const auto row = frame.pixels.subspan(pixel * kBytesPerPixel, rowBytes);
    batch.pixels.insert(batch.pixels.end(), row.begin(), row.end());
  }
  batch.boxes.push_back(box);
}

// Fills batch after batch; every batch but the last leaves when the next row does not fit into it.
class Cutter {
 public:
  Cutter(const FrameView& frame, const Update& update, FrameBelt& belt, const std::stop_token& stop)
      : frame_(frame),
        update_(update),
        belt_(belt),
        stop_(stop),
        bytesLeft_(static_cast<std::size_t>(update.damage.area()) * kBytesPerPixel) {}

  bool add(Box box) {
    const std::size_t rowBytes = static_cast<std::size_t>(box.width()) * kBytesPerPixel;
    while (!box.empty()) {
      const std::size_t room = batch_ == nullptr ? 0 : FrameBelt::kMaxBytes - batch_->pixels.size();
      const int rows = static_cast<int>(std::min<std::size_t>(room / rowBytes, static_cast<std::size_t>(box.height())));
      if (rows == 0) {
        if (!startBatch()) return false;
        continue;
      }
      appendRows(frame_, {box.left, box.top, box.right, box.top + rows}, *batch_);
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
    if (batch_ != nullptr) {
      bytesLeft_ -= batch_->pixels.size();
      belt_.publish(batch_);
    }
    batch_ = belt_.acquire(stop_);
    if (batch_ == nullptr) return false;
    batch_->update = update_.serial;
    batch_->received = update_.received;
    batch_->desktop = frame_.size;
    batch_->pixels.reserve(std::min(bytesLeft_, FrameBelt::kMaxBytes));
    return true;
  }

  const FrameView& frame_;
  const Update& update_;
  FrameBelt& belt_;
  const std::stop_token& stop_;
  std::size_t bytesLeft_;
  Batch* batch_ = nullptr;
};

}  // namespace

bool publishUpdate(const FrameView& frame, const Update& update, FrameBelt& belt, const std::stop_token& stop) {
  static_assert(kBytesPerPixel * 65536 <= FrameBelt::kMaxBytes, "a row must fit into a batch");
  if (update.damage.empty()) return true;
  Cutter cutter(frame, update, belt, stop);
  for (const Box& box : update.damage.boxes()) {
    assert(boxOf(frame.size).contains(box));
    if (!cutter.add(box)) return false;
  }
  cutter.finish();
  return true;
}

}  // namespace pixelflex::viewer
