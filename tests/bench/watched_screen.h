#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <glm/vec2.hpp>

#include "devices/image/size.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {

/// An Xvfb whose screen is memory that this process sees, too: looking at a pixel costs the server nothing, and nobody
/// waits for it.
class WatchedScreen {
 public:
  explicit WatchedScreen(devices::Size size);
  ~WatchedScreen();
  WatchedScreen(const WatchedScreen&) = delete;
  WatchedScreen& operator=(const WatchedScreen&) = delete;

  [[nodiscard]] XServer& x() { return x_; }
  /// 0xRRGGBB, as it is at this moment; any thread.
  [[nodiscard]] std::uint32_t pixel(glm::ivec2 at) const;
  /// The first pixel of this colour, row by row.
  [[nodiscard]] std::optional<glm::ivec2> find(std::uint32_t colour) const;

 private:
  devices::Size size_;
  XServer x_;
  void* memory_ = nullptr;
  std::size_t bytes_ = 0;
  std::size_t pixels_ = 0;  // where they begin
  std::size_t row_ = 0;     // bytes
};

}  // namespace pixelflex::testing
