#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "viewer/tiles/frame_belt.h"
#include "viewer/tiles/region.h"
#include "viewer/x11/pixel_batches.h"
#include "viewer/x11/shared_pixels.h"
#include "viewer/x11/x_connection.h"

namespace pixelflex::viewer {

/// What a screen shows and where it changed: the server keeps track of its damage and writes the damaged boxes, each as
/// it is at one moment, into memory that both share. The session's thread.
class ScreenCapture {
 public:
  /// Throws SessionError (kUnsupported) for a screen that is not true colour with 8 bits each or a server without the
  /// extensions. The whole screen counts as damaged. `connection` must outlive this.
  explicit ScreenCapture(const XConnection& connection);
  ~ScreenCapture();
  ScreenCapture(const ScreenCapture&) = delete;
  ScreenCapture& operator=(const ScreenCapture&) = delete;

  void handle(const XEvent& event);
  [[nodiscard]] devices::Size size() const { return size_; }
  [[nodiscard]] bool damaged() const { return damaged_; }
  /// Puts the damaged boxes onto the belt and calls them undamaged. False when there was nothing to show after all, as
  /// when the screen changed its size meanwhile: then it is damaged again. Throws SessionStopped.
  bool publish(std::uint64_t serial, FrameBelt& belt, const std::stop_token& stop);

 private:
  void useExtensions();
  void requireFormat();
  void adopt(devices::Size size);
  [[nodiscard]] Region takeDamage();
  [[nodiscard]] bool fetch(const Region& region);
  void checkSize();

  const XConnection& connection_;
  PixelLayout layout_;
  std::uint32_t root_ = 0;
  std::uint32_t damage_ = 0;
  std::uint32_t region_ = 0;
  std::uint32_t segment_ = 0;
  int damageEvent_ = 0;
  devices::Size size_;
  SharedPixels pixels_;
  bool damaged_ = true;
  bool whole_ = true;
  int failures_ = 0;  // in a row
};

}  // namespace pixelflex::viewer
