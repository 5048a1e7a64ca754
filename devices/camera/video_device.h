#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace pixelflex::devices {

/// A video device as the kernel offers it: the few system calls that V4L2 consists of.
class VideoDevice {
 public:
  VideoDevice() = default;
  virtual ~VideoDevice() = default;
  VideoDevice(const VideoDevice&) = delete;
  VideoDevice& operator=(const VideoDevice&) = delete;

  /// One of the VIDIOC requests with its argument: 0, or an error number.
  virtual int request(unsigned long code, void* argument) = 0;
  /// A buffer of the device's in our memory, as long as this lives. Empty when it cannot be had.
  [[nodiscard]] virtual std::span<const std::uint8_t> map(std::size_t length, std::int64_t offset) = 0;
  /// Whether a frame is there before the time is over.
  [[nodiscard]] virtual bool wait(std::chrono::milliseconds patience) = 0;
};

/// Throws std::system_error.
[[nodiscard]] std::unique_ptr<VideoDevice> openVideoDevice(const std::string& path);

}  // namespace pixelflex::devices
