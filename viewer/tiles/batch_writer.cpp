#include "viewer/tiles/batch_writer.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kBytesPerPixel = 4;
static_assert(kBytesPerPixel * 65536 <= FrameBelt::kMaxBytes, "a row must fit into a batch");

}  // namespace

BatchWriter::BatchWriter(const Header& header, FrameBelt& belt, std::stop_token stop, AppendRows append)
    : header_(header), belt_(belt), stop_(std::move(stop)), append_(std::move(append)), bytesLeft_(header.bytes) {}

bool BatchWriter::add(Box box) {
  const std::size_t rowBytes = static_cast<std::size_t>(box.width()) * kBytesPerPixel;
  while (!box.empty()) {
    const std::size_t room = batch_ == nullptr ? 0 : FrameBelt::kMaxBytes - batch_->pixels.size();
    const int rows = static_cast<int>(std::min<std::size_t>(room / rowBytes, static_cast<std::size_t>(box.height())));
    if (rows == 0) {
      if (!startBatch()) return false;
      continue;
    }
    const Box part{box.left, box.top, box.right, box.top + rows};
    append_(part, batch_->pixels);
    batch_->boxes.push_back(part);
    box.top += rows;
  }
  return true;
}

void BatchWriter::finish() {
  assert(batch_ != nullptr);
  batch_->completesUpdate = true;
  belt_.publish(batch_);
}

bool BatchWriter::startBatch() {
  if (batch_ != nullptr) {
    bytesLeft_ -= batch_->pixels.size();
    belt_.publish(batch_);
  }
  batch_ = belt_.acquire(stop_);
  if (batch_ == nullptr) return false;
  batch_->update = header_.update;
  batch_->received = header_.received;
  batch_->decoded = decoded_;
  batch_->decoding = header_.decoding;
  batch_->desktop = header_.desktop;
  batch_->pixels.reserve(std::min(bytesLeft_, FrameBelt::kMaxBytes));
  return true;
}

}  // namespace pixelflex::viewer
