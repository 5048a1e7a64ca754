#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>

#include "viewer/tiles/frame_belt.h"
#include "viewer/tiles/region.h"

namespace pixelflex::viewer {

/// Where a pixel of 32 bits, as this machine reads it, has its colours of 8 bits each.
struct PixelLayout {
  int redShift = 16;
  int greenShift = 8;
  int blueShift = 0;
};

/// A whole update: the boxes' pixels in their order, rows without padding.
struct PackedUpdate {
  std::uint64_t serial = 0;
  std::chrono::steady_clock::time_point received;
  devices::Size desktop;
  Region damage;  // not empty
  std::span<const std::byte> pixels;
  PixelLayout layout;
  std::chrono::nanoseconds decoding{0};  // processor time since it was received
};

/// Copies the pixels once, as red, green, blue and a byte without meaning, onto the belt, in as many batches of at most
/// FrameBelt::kMaxBytes as it takes; the last one completes the update. Waits while the belt is full. False when
/// stopped, perhaps half way.
bool publishPacked(const PackedUpdate& update, FrameBelt& belt, const std::stop_token& stop);

}  // namespace pixelflex::viewer
