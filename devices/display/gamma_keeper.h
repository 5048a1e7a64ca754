#pragma once

#include <sys/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "devices/image/size.h"

namespace pixelflex::devices {

/// What the hardware of an output makes of codes: for red, green and blue, of evenly spaced codes, 65535 the highest.
using GammaRamp = std::array<std::vector<std::uint16_t>, 3>;

/// Sets the look-up tables of outputs through RandR, and gives back those that they had when this ends, however it
/// ends: a process of its own does it, which outlives a crash. One thread. Make it before any other thread is started.
class GammaKeeper {
 public:
  /// `display`: as EventLoop's. Throws std::system_error when there can be no process.
  explicit GammaKeeper(std::optional<std::string> display = std::nullopt);
  /// Everything is given back when this returns.
  ~GammaKeeper();
  GammaKeeper(const GammaKeeper&) = delete;
  GammaKeeper& operator=(const GammaKeeper&) = delete;

  /// How many entries each table has of the output that shows just this rectangle of the display; 0: there is none
  /// that can.
  [[nodiscard]] std::size_t entriesAt(glm::ivec2 topLeft, Size size);
  /// For the same output; channels of as many entries. Throws DisplayError.
  void set(glm::ivec2 topLeft, Size size, const GammaRamp& ramp);

 private:
  std::size_t ask(const void* request, std::size_t bytes);

  int socket_ = -1;
  pid_t child_ = -1;
};

}  // namespace pixelflex::devices
