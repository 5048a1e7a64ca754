#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory_resource>
#include <mutex>
#include <span>
#include <stop_token>
#include <vector>

#include "viewer/tiles/box.h"

namespace pixelflex::viewer {

/// Rows of pixels in memory that their reader has chosen.
using PixelBytes = std::pmr::vector<std::byte>;

/// A part of one server update on its way to the GPU. Pixels are 4 bytes each, red, green, blue, undefined; the boxes'
/// rows follow each other without padding, box after box.
struct Batch {
  std::uint64_t update = 0;                        // serial number of the server's update
  std::chrono::steady_clock::time_point received;  // when the update's first byte was there
  std::chrono::steady_clock::time_point decoded;   // when the whole update was
  std::chrono::nanoseconds decoding{0};            // processor time that it took in between
  devices::Size desktop;                           // a change of size makes the whole desktop damaged
  std::vector<Box> boxes;
  PixelBytes pixels;
  bool completesUpdate = false;  // only then may the wall change: never half an update
};

/// The hand-over between the network thread and the render thread: three batches of bounded size, so that a server
/// that sends faster than the wall draws is held back by its socket (report 6.1; no queue grows). One producer, one
/// consumer.
class FrameBelt {
 public:
  static constexpr std::size_t kSlots = 3;
  /// Larger updates travel in several batches.
  static constexpr std::size_t kMaxBytes = std::size_t{4} << 20;

  /// `wake` is called from the producer's thread after every publish and must be thread-safe. The slots' pixels lie in
  /// `memory`, which must outlive the belt and is asked by both threads; null: on the heap, as they grow.
  explicit FrameBelt(std::function<void()> wake, std::pmr::memory_resource* memory = nullptr);

  /// Network thread: a free batch, cleared; waits for one. Null when stopped.
  [[nodiscard]] Batch* acquire(std::stop_token stop);
  /// Network thread: hands a batch from acquire() over.
  void publish(Batch* batch);

  /// Render thread: the oldest published batch or null; give it back with release() once its pixels have been read.
  [[nodiscard]] Batch* take();
  void release(Batch* batch);

 private:
  std::function<void()> wake_;
  std::mutex mutex_;
  std::condition_variable_any freed_;
  std::vector<Batch> slots_;
  std::deque<Batch*> free_;
  std::deque<Batch*> published_;
};

}  // namespace pixelflex::viewer
