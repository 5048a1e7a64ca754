#include "viewer/tiles/frame_belt.h"

#include <cassert>
#include <utility>

namespace pixelflex::viewer {

FrameBelt::FrameBelt(std::function<void()> wake, std::pmr::memory_resource* memory) : wake_(std::move(wake)) {
  slots_.reserve(kSlots);
  for (std::size_t i = 0; i < kSlots; ++i) {
    PixelBytes pixels(memory == nullptr ? std::pmr::new_delete_resource() : memory);
    if (memory != nullptr) pixels.reserve(kMaxBytes);  // at once: to grow is to read, which such memory may be slow at
    slots_.push_back({.pixels = std::move(pixels)});
  }
  for (Batch& slot : slots_) free_.push_back(&slot);
}

Batch* FrameBelt::acquire(std::stop_token stop) {
  std::unique_lock lock(mutex_);
  if (!freed_.wait(lock, std::move(stop), [this] { return !free_.empty(); })) return nullptr;
  Batch* batch = free_.front();
  free_.pop_front();
  // The vectors keep their memory, so that a busy desktop does not allocate.
  batch->boxes.clear();
  batch->pixels.clear();
  batch->completesUpdate = false;
  return batch;
}

void FrameBelt::publish(Batch* batch) {
  assert(batch != nullptr);
  {
    const std::lock_guard lock(mutex_);
    published_.push_back(batch);
  }
  if (wake_) wake_();
}

Batch* FrameBelt::take() {
  const std::lock_guard lock(mutex_);
  if (published_.empty()) return nullptr;
  Batch* batch = published_.front();
  published_.pop_front();
  return batch;
}

void FrameBelt::release(Batch* batch) {
  assert(batch != nullptr);
  {
    const std::lock_guard lock(mutex_);
    free_.push_back(batch);
  }
  freed_.notify_one();
}

}  // namespace pixelflex::viewer
