#include "devices/camera/v4l2_settings.h"

#include <linux/videodev2.h>

#include <array>

namespace pixelflex::devices {
namespace {

struct Readable {
  std::uint32_t code;
  std::optional<RawLayout> layout;
};
/// The best first: compression bends light.
constexpr std::array kReadable = {
    Readable{V4L2_PIX_FMT_RGB24, RawLayout::kRgb8}, Readable{V4L2_PIX_FMT_BGR24, RawLayout::kBgr8},
    Readable{V4L2_PIX_FMT_YUYV, RawLayout::kYuyv},  Readable{V4L2_PIX_FMT_UYVY, RawLayout::kUyvy},
    Readable{V4L2_PIX_FMT_GREY, RawLayout::kGrey8}, Readable{V4L2_PIX_FMT_MJPEG, std::nullopt},
    Readable{V4L2_PIX_FMT_JPEG, std::nullopt}};

bool offers(VideoDevice& device, std::uint32_t code) {
  v4l2_fmtdesc format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  for (; device.request(VIDIOC_ENUM_FMT, &format) == 0; ++format.index) {
    if (format.pixelformat == code) return true;
  }
  return false;
}

Size largestSize(VideoDevice& device, std::uint32_t code) {
  Size largest;
  v4l2_frmsizeenum sizes{};
  sizes.pixel_format = code;
  for (; device.request(VIDIOC_ENUM_FRAMESIZES, &sizes) == 0; ++sizes.index) {
    const bool discrete = sizes.type == V4L2_FRMSIZE_TYPE_DISCRETE;
    const Size size{static_cast<int>(discrete ? sizes.discrete.width : sizes.stepwise.max_width),
                    static_cast<int>(discrete ? sizes.discrete.height : sizes.stepwise.max_height)};
    if (size.area() > largest.area()) largest = size;
    if (!discrete) break;
  }
  return largest;
}

struct Manual {
  std::uint32_t control;
  const char* name;
  std::int32_t value;
  bool required = true;
};
constexpr std::array kManual = {Manual{V4L2_CID_EXPOSURE_AUTO, "automatic exposure", V4L2_EXPOSURE_MANUAL},
                                Manual{V4L2_CID_EXPOSURE_AUTO_PRIORITY, "automatic frame rate", 0, false},
                                Manual{V4L2_CID_AUTOGAIN, "automatic gain", 0},
                                Manual{V4L2_CID_AUTO_WHITE_BALANCE, "automatic white balance", 0},
                                Manual{V4L2_CID_FOCUS_AUTO, "automatic focus", 0},
                                Manual{V4L2_CID_HUE_AUTO, "automatic hue", 0, false},
                                Manual{V4L2_CID_BACKLIGHT_COMPENSATION, "backlight compensation", 0, false}};

}  // namespace

std::optional<V4l2Format> bestFormat(VideoDevice& device) {
  std::optional<V4l2Format> best;
  for (const auto& [code, layout] : kReadable) {
    if (!offers(device, code)) continue;
    const Size size = largestSize(device, code);
    if (size.area() > (best ? best->size.area() : 0)) best = V4l2Format{code, size, layout};
  }
  return best;
}

std::optional<V4l2Range> controlRange(VideoDevice& device, std::uint32_t control) {
  v4l2_queryctrl query{};
  query.id = control;
  if (device.request(VIDIOC_QUERYCTRL, &query) != 0 || (query.flags & V4L2_CTRL_FLAG_DISABLED) != 0) {
    return std::nullopt;
  }
  return V4l2Range{query.minimum, query.maximum};
}

std::optional<std::int32_t> readControl(VideoDevice& device, std::uint32_t control) {
  v4l2_control value{.id = control, .value = 0};
  if (device.request(VIDIOC_G_CTRL, &value) != 0) return std::nullopt;
  return value.value;
}

std::optional<std::int32_t> writeControl(VideoDevice& device, std::uint32_t control, std::int32_t value) {
  v4l2_control wanted{.id = control, .value = value};
  (void)device.request(VIDIOC_S_CTRL, &wanted);
  return readControl(device, control);
}

std::vector<std::string> makeManual(VideoDevice& device) {
  std::vector<std::string> stayed;
  for (const auto& [control, name, value, required] : kManual) {
    if (!controlRange(device, control)) continue;
    const auto now = writeControl(device, control, value);
    if (required && now != value) stayed.emplace_back(name);
  }
  return stayed;
}

}  // namespace pixelflex::devices
