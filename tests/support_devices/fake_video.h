#pragma once

#include <linux/videodev2.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <vector>

#include "devices/camera/video_device.h"

namespace pixelflex::testing {

/// A camera behind V4L2's requests, as the kernel's documentation has them: formats, controls with ranges, and a stream
/// of four buffers that runs by itself, a frame every 40 ms of a clock of its own that starts at the real one.
class FakeVideo : public devices::VideoDevice {
 public:
  struct Control {
    int minimum = 0, maximum = 1, value = 1;
    bool stuck = false;
    int refusals = 0;  // so many times a write is taken and forgotten
  };
  struct Format {
    std::uint32_t code;
    std::vector<std::array<std::uint32_t, 2>> sizes;
  };
  std::vector<Format> formats = {{V4L2_PIX_FMT_GREY, {{8, 6}}}};
  std::map<std::uint32_t, Control> controls = {{V4L2_CID_EXPOSURE_AUTO, {0, 3, V4L2_EXPOSURE_APERTURE_PRIORITY}},
                                               {V4L2_CID_EXPOSURE_ABSOLUTE, {3, 2047, 250}},
                                               {V4L2_CID_AUTO_WHITE_BALANCE, {0, 1, 1}},
                                               {V4L2_CID_FOCUS_AUTO, {0, 1, 1}}};
  std::uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::uint32_t stamps = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  int busy = 0;     // the error of REQBUFS
  int gone = 0;     // the error of DQBUF
  int damaged = 0;  // so many frames to come are
  bool silent = false;
  std::vector<std::uint8_t> jpeg;  // what is sent of compressed formats

  static constexpr std::chrono::microseconds kPeriod{40000};
  std::chrono::microseconds now =
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now().time_since_epoch());
  int frames = 0;  // that were taken since the beginning

  int request(unsigned long code, void* argument) override {
    switch (code) {
      case VIDIOC_QUERYCAP:
        static_cast<v4l2_capability*>(argument)->capabilities = capabilities;
        return 0;
      case VIDIOC_ENUM_FMT:
        return enumFormat(*static_cast<v4l2_fmtdesc*>(argument));
      case VIDIOC_ENUM_FRAMESIZES:
        return enumSize(*static_cast<v4l2_frmsizeenum*>(argument));
      case VIDIOC_S_FMT:
        return setFormat(static_cast<v4l2_format*>(argument)->fmt.pix);
      case VIDIOC_G_PARM:
        static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = {1, 25};
        return 0;
      case VIDIOC_QUERYCTRL:
        return queryControl(*static_cast<v4l2_queryctrl*>(argument));
      case VIDIOC_G_CTRL:
      case VIDIOC_S_CTRL:
        return useControl(*static_cast<v4l2_control*>(argument), code == VIDIOC_S_CTRL);
      default:
        return stream(code, argument);
    }
  }
  [[nodiscard]] std::span<const std::uint8_t> map(std::size_t length, std::int64_t offset) override {
    return std::span(memory_).subspan(static_cast<std::size_t>(offset), length);
  }
  /// The time goes on until there is a frame.
  [[nodiscard]] bool wait(std::chrono::milliseconds patience) override {
    if (silent) return false;
    if (filled_.empty()) pass(kPeriod);
    return !filled_.empty() && patience > kPeriod;
  }
  /// Frames come meanwhile, as long as there are buffers for them.
  void pass(std::chrono::microseconds time) {
    for (const auto end = now + time; now + kPeriod <= end && !empty_.empty();) {
      now += kPeriod;
      fill(empty_.front());
      empty_.pop_front();
    }
  }
  [[nodiscard]] std::uint32_t pixelFormat() const { return format_.pixelformat; }

 private:
  struct Filled {
    std::uint32_t index;
    std::chrono::microseconds stamp;
    std::uint32_t bytes;
    std::uint32_t flags;
  };

  int enumFormat(v4l2_fmtdesc& wanted) const {
    if (wanted.index >= formats.size()) return EINVAL;
    wanted.pixelformat = formats[wanted.index].code;
    return 0;
  }
  int enumSize(v4l2_frmsizeenum& wanted) const {
    for (const auto& [code, sizes] : formats) {
      if (code != wanted.pixel_format || wanted.index >= sizes.size()) continue;
      wanted.type = V4L2_FRMSIZE_TYPE_DISCRETE;
      wanted.discrete = {sizes[wanted.index][0], sizes[wanted.index][1]};
      return 0;
    }
    return EINVAL;
  }
  int setFormat(v4l2_pix_format& wanted) {
    wanted.bytesperline = wanted.pixelformat == V4L2_PIX_FMT_YUYV ? 2 * wanted.width : wanted.width;
    wanted.sizeimage = wanted.bytesperline * wanted.height + 4096;
    format_ = wanted;
    return 0;
  }
  int queryControl(v4l2_queryctrl& query) const {
    const auto found = controls.find(query.id);
    if (found == controls.end()) return EINVAL;
    query.minimum = found->second.minimum;
    query.maximum = found->second.maximum;
    return 0;
  }
  int useControl(v4l2_control& control, bool writes) {
    const auto found = controls.find(control.id);
    if (found == controls.end()) return EINVAL;
    if (!writes) {
      control.value = found->second.value;
    } else if (control.value < found->second.minimum || control.value > found->second.maximum) {
      return ERANGE;
    } else if (found->second.refusals > 0) {
      --found->second.refusals;
    } else if (!found->second.stuck) {
      found->second.value = control.value;
    }
    return 0;
  }
  int stream(unsigned long code, void* argument) {
    auto* buffer = static_cast<v4l2_buffer*>(argument);
    switch (code) {
      case VIDIOC_REQBUFS:
        memory_.resize(std::size_t{4} * format_.sizeimage);
        return busy;
      case VIDIOC_QUERYBUF:
        buffer->length = format_.sizeimage;
        buffer->m.offset = buffer->index * format_.sizeimage;
        return 0;
      case VIDIOC_QBUF:
        empty_.push_back(buffer->index);
        return 0;
      case VIDIOC_DQBUF:
        return gone != 0 ? gone : take(*buffer);
      default:
        return 0;
    }
  }
  int take(v4l2_buffer& buffer) {
    if (filled_.empty()) return EAGAIN;
    const Filled frame = filled_.front();
    filled_.pop_front();
    buffer.index = frame.index;
    buffer.bytesused = frame.bytes;
    buffer.flags = frame.flags | stamps;
    buffer.timestamp.tv_sec = frame.stamp.count() / 1000000;
    buffer.timestamp.tv_usec = frame.stamp.count() % 1000000;
    return 0;
  }
  /// Every sample is the number of the frame.
  void fill(std::uint32_t index) {
    ++frames;
    const std::span buffer = std::span(memory_).subspan(std::size_t{index} * format_.sizeimage, format_.sizeimage);
    std::ranges::fill(buffer, static_cast<std::uint8_t>(frames));
    if (format_.pixelformat == V4L2_PIX_FMT_MJPEG) std::ranges::copy(jpeg, buffer.begin());
    const auto bytes = format_.pixelformat == V4L2_PIX_FMT_MJPEG ? jpeg.size() : format_.sizeimage;
    const std::uint32_t flags = damaged > 0 ? V4L2_BUF_FLAG_ERROR : 0;
    if (damaged > 0) --damaged;
    filled_.push_back({index, now, static_cast<std::uint32_t>(bytes), flags});
  }

  v4l2_pix_format format_{};
  std::vector<std::uint8_t> memory_;
  std::deque<std::uint32_t> empty_;
  std::deque<Filled> filled_;
};

}  // namespace pixelflex::testing
