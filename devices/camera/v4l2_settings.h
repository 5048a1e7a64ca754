#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "devices/camera/raw_picture.h"
#include "devices/camera/video_device.h"

namespace pixelflex::devices {

/// How a device can send pictures, and what is used of that.
struct V4l2Format {
  std::uint32_t code = 0;  // of V4L2
  Size size;
  std::optional<RawLayout> layout;  // none: JPEG
};
/// The largest that can be read here, of equals the one that says most about light; none when none can be.
[[nodiscard]] std::optional<V4l2Format> bestFormat(VideoDevice& device);

/// A control's range; none where the device has no such control, or it cannot be used now.
struct V4l2Range {
  std::int32_t minimum = 0, maximum = 0;
};
[[nodiscard]] std::optional<V4l2Range> controlRange(VideoDevice& device, std::uint32_t control);
[[nodiscard]] std::optional<std::int32_t> readControl(VideoDevice& device, std::uint32_t control);
/// What it is then, whether it was accepted or not.
[[nodiscard]] std::optional<std::int32_t> writeControl(VideoDevice& device, std::uint32_t control, std::int32_t value);

/// Makes everything manual that the device would otherwise change by itself. The names of what stayed automatic.
[[nodiscard]] std::vector<std::string> makeManual(VideoDevice& device);

}  // namespace pixelflex::devices
