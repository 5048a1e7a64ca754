#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <vector>

#include "viewer/tiles/frame_belt.h"

namespace pixelflex::viewer {

/// Cuts one whole update into batches: every batch but the last leaves when the next row does not fit into it. Waits
/// while the belt is full.
class BatchWriter {
 public:
  struct Header {
    std::uint64_t update = 0;
    std::chrono::steady_clock::time_point received;
    std::chrono::nanoseconds decoding{0};  // as the batch has it
    devices::Size desktop;
    std::size_t bytes = 0;  // of all its pixels
  };
  /// Appends the pixels of these rows, four bytes each.
  using AppendRows = std::function<void(const Box& rows, PixelBytes& pixels)>;

  /// The update counts as decoded from here on. The belt must outlive this.
  BatchWriter(const Header& header, FrameBelt& belt, std::stop_token stop, AppendRows append);

  /// False when stopped; the update then never completes.
  [[nodiscard]] bool add(Box box);
  /// After the last box; at least one was added.
  void finish();

 private:
  [[nodiscard]] bool startBatch();

  Header header_;
  FrameBelt& belt_;
  std::stop_token stop_;
  AppendRows append_;
  std::chrono::steady_clock::time_point decoded_ = std::chrono::steady_clock::now();
  std::size_t bytesLeft_;
  Batch* batch_ = nullptr;
};

}  // namespace pixelflex::viewer
