#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "viewer/tiles/frame_belt.h"

namespace pixelflex::viewer {

/// Where an update's time goes, from its first byte to the end of the swap that shows it.
enum class Stage {
  kReceive,  // waiting for the rest of it, from the server or from the processor
  kDecode,   // processor time of the thread that decodes it
  kQueue,    // copied onto the belt, and waiting there for the render thread
  kUpload,   // to the GPU
  kDraw,     // the frames of the projectors that it touches, until the GPU is done
  kSwap,     // of their windows, vsync included
  kTotal,    // from its first byte to the end of the swap
};
inline constexpr std::size_t kStages = 7;
[[nodiscard]] std::string_view nameOf(Stage stage);

struct StageFigures {
  std::chrono::nanoseconds median{0}, p99{0}, max{0};
};

struct StageSummary {
  std::size_t updates = 0;
  std::array<StageFigures, kStages> stages;  // by Stage
};

/// Stage times of the last updates that were shown. On the render thread alone; allocates only when made and for a
/// summary.
class StageStats {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::size_t kKept = 1024;

  StageStats();

  /// A batch was uploaded. Those of one update come one after the other.
  void uploaded(const Batch& batch, Time begin, Time end);
  /// Whatever is uploaded whole was drawn.
  void drawn(Time begin, Time end);
  /// Whatever is drawn was swapped, which began when the drawing ended.
  void shown(Time end);

  /// How many updates were shown since this was made.
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// Of the last `updates` of them, or of as many of those as are kept.
  [[nodiscard]] StageSummary summaryOfLast(std::uint64_t updates) const;

 private:
  using Sample = std::array<std::chrono::nanoseconds, kStages>;
  struct Open {
    std::uint64_t update = 0;
    Time received;
    Time drawn;
    bool complete = false;
    bool isDrawn = false;
    Sample sample{};
  };

  std::vector<Open> open_;       // oldest first; only the last may be incomplete
  std::vector<Sample> samples_;  // a ring
  std::uint64_t count_ = 0;
};

}  // namespace pixelflex::viewer
