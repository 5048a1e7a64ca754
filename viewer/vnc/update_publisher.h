#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>

#include "viewer/tiles/frame_belt.h"
#include "viewer/tiles/region.h"

namespace pixelflex::viewer {

/// The session's linear frame buffer: four bytes a pixel, rows without padding.
struct FrameView {
  std::span<const std::byte> pixels;
  devices::Size size;
};

/// One whole update of the server.
struct Update {
  std::uint64_t serial = 0;
  std::chrono::steady_clock::time_point received;  // when its first byte was there
  Region damage;                                   // inside the frame
  std::chrono::nanoseconds decoding{0};            // processor time since then
};

/// Copies the damaged pixels once onto the belt, in as many batches of at most FrameBelt::kMaxBytes as it takes; the
/// last one completes the update. Waits while the belt is full. Nothing is published for an empty region. False when
/// stopped, perhaps half way.
bool publishUpdate(const FrameView& frame, const Update& update, FrameBelt& belt, const std::stop_token& stop);

}  // namespace pixelflex::viewer
