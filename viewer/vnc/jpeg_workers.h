#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "viewer/tiles/box.h"

namespace pixelflex::viewer {

/// Decodes the JPEG pictures of an update on threads of their own, straight into the session's frame buffer, while the
/// session's thread reads on. Each owns its box of the frame until waitFor() or finish(). The threads start with the
/// first picture. Everything is called by the session's thread.
class JpegWorkers {
 public:
  struct Free {
    void operator()(const std::uint8_t* memory) const { std::free(const_cast<std::uint8_t*>(memory)); }
  };
  struct Picture {
    std::unique_ptr<const std::uint8_t, Free> jpeg;
    std::size_t bytes = 0;
    Box box;                      // of the desktop
    std::uint8_t* out = nullptr;  // its first pixel, as decodeJpegRect has it
    std::size_t rowBytes = 0;
  };

  JpegWorkers() = default;
  /// Waits for what is being decoded, and forgets the rest.
  ~JpegWorkers();
  JpegWorkers(const JpegWorkers&) = delete;
  JpegWorkers& operator=(const JpegWorkers&) = delete;

  /// Pictures smaller than this are not worth the hand-over.
  static constexpr std::int64_t kWorthwhilePixels = 16384;

  /// Decodes a picture here when too many are waiting already.
  void add(Picture picture);
  /// Until no picture that was added touches the box.
  void waitFor(const Box& box);
  /// Until all are decoded, helping. False when one of them since the last call was damaged.
  [[nodiscard]] bool finish();

 private:
  void start();
  void work(const std::stop_token& stop);
  [[nodiscard]] bool touches(const Box& box) const;
  /// Takes the oldest picture that waits and decodes it with the lock let go. The lock is held before and after.
  void decodeOne(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable_any wanted_, decoded_;
  std::deque<Picture> waiting_;
  std::vector<Box> beingDecoded_;
  bool damaged_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace pixelflex::viewer
