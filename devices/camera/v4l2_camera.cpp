#include "devices/camera/v4l2_camera.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "devices/camera/camera_error.h"
#include "devices/camera/raw_picture.h"
#include "devices/camera/v4l2_settings.h"
#include "devices/image/photo_file.h"

namespace pixelflex::devices {
namespace {

using Clock = std::chrono::steady_clock;  // CLOCK_MONOTONIC, as the kernel's time stamps
using Seconds = std::chrono::duration<double>;

constexpr double kExposureUnit = 1e-4;  // seconds
constexpr std::uint32_t kBuffers = 4;
constexpr Seconds kPatience{5};     // for a frame, beside its exposure
constexpr int kSpoiltFrames = 20;   // in a row
constexpr int kStaleFrames = 100;   // beside those that an exposure lasts
constexpr int kFramesUntilSet = 3;  // that a changed exposure may take to show
constexpr std::uint32_t kCapture = V4L2_BUF_TYPE_VIDEO_CAPTURE;

std::optional<v4l2_capability> capabilityOf(VideoDevice& device) {
  v4l2_capability capability{};
  if (device.request(VIDIOC_QUERYCAP, &capability) != 0) return std::nullopt;
  const auto flags =
      (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? capability.device_caps : capability.capabilities;
  if ((flags & V4L2_CAP_VIDEO_CAPTURE) == 0 || (flags & V4L2_CAP_STREAMING) == 0) return std::nullopt;
  return capability;
}

class V4l2Camera final : public Camera, public ExposureControl {
 public:
  V4l2Camera(std::string source, std::unique_ptr<VideoDevice> device)
      : source_(std::move(source)), device_(std::move(device)) {
    if (!capabilityOf(*device_)) {
      throw CameraError(source_ +
                        ": this device gives no pictures (cameras often have a second one, for other data): "
                        "pixelflex camera list shows those that do");
    }
    chooseFormat();
    lock();
    start();
  }
  ~V4l2Camera() override {
    auto type = static_cast<int>(kCapture);
    (void)device_->request(VIDIOC_STREAMOFF, &type);
  }
  V4l2Camera(const V4l2Camera&) = delete;
  V4l2Camera& operator=(const V4l2Camera&) = delete;

  [[nodiscard]] Size size() const override { return format_.size; }
  [[nodiscard]] Image8 shoot() override;
  [[nodiscard]] ExposureControl* exposureControl() override { return range_.longest > 0 ? this : nullptr; }
  [[nodiscard]] ExposureRange exposureRange() const override { return range_; }
  [[nodiscard]] double exposure() override { return exposure_; }
  double setExposure(double seconds) override;

 private:
  void chooseFormat();
  void lock();
  void start();
  void demand(unsigned long code, void* argument, const std::string& what);
  [[nodiscard]] v4l2_buffer takeBuffer();
  void giveBack(std::uint32_t index);
  [[nodiscard]] bool isFresh(const v4l2_buffer& buffer, Clock::time_point asked, int seen) const;
  [[nodiscard]] std::optional<Image8> pictureOf(const v4l2_buffer& buffer);

  std::string source_;
  std::unique_ptr<VideoDevice> device_;
  V4l2Format format_;
  std::size_t stride_ = 0;
  ExposureRange range_;
  double exposure_ = 0;
  Seconds period_{0.2};
  int unset_ = 0;  // frames to come that may have the exposure before
  std::vector<std::span<const std::uint8_t>> buffers_;
  std::string trouble_ = "no frame comes";
};

void V4l2Camera::demand(unsigned long code, void* argument, const std::string& what) {
  const int error = device_->request(code, argument);
  if (error == 0) return;
  if (error == EBUSY) throw CameraError(source_ + ": another program uses this camera: end that first");
  if (error == ENODEV) throw CameraError(source_ + ": the camera is gone: plug it in again, then start again");
  throw CameraError(source_ + ": " + what + ": " + std::strerror(error));
}

void V4l2Camera::chooseFormat() {
  const auto best = bestFormat(*device_);
  if (!best) {
    throw CameraError(source_ +
                      ": none of its pixel formats can be read here: it needs RGB24, BGR24, YUYV, UYVY, GREY "
                      "or MJPG (v4l2-ctl --list-formats-ext shows its own)");
  }
  format_ = *best;
  v4l2_format wanted{};
  wanted.type = kCapture;
  wanted.fmt.pix.width = static_cast<std::uint32_t>(format_.size.width);
  wanted.fmt.pix.height = static_cast<std::uint32_t>(format_.size.height);
  wanted.fmt.pix.pixelformat = format_.code;
  wanted.fmt.pix.field = V4L2_FIELD_NONE;
  demand(VIDIOC_S_FMT, &wanted, "its pixel format cannot be set");
  if (wanted.fmt.pix.pixelformat != format_.code) {
    throw CameraError(source_ + ": it takes none of the pixel formats that it offers");
  }
  format_.size = {static_cast<int>(wanted.fmt.pix.width), static_cast<int>(wanted.fmt.pix.height)};
  stride_ = wanted.fmt.pix.bytesperline;
  v4l2_streamparm rate{};
  rate.type = kCapture;
  const auto& time = rate.parm.capture.timeperframe;
  if (device_->request(VIDIOC_G_PARM, &rate) == 0 && time.numerator > 0 && time.denominator > 0) {
    period_ = Seconds(static_cast<double>(time.numerator) / time.denominator);
  }
}

void V4l2Camera::lock() {
  const auto stayed = makeManual(*device_);
  if (!stayed.empty()) {
    std::string names;
    for (const auto& name : stayed) names += (names.empty() ? "" : ", ") + name;
    throw CameraError(source_ + ": it does not let itself be set: " + names +
                      " stays on. Switch it off at the camera, or photograph by hand (--patterns DIR, --photos DIR)");
  }
  const auto range = controlRange(*device_, V4L2_CID_EXPOSURE_ABSOLUTE);
  const auto now = readControl(*device_, V4L2_CID_EXPOSURE_ABSOLUTE);
  if (!range || !now) return;
  range_ = {kExposureUnit * std::max(1, range->minimum), kExposureUnit * range->maximum};
  exposure_ = kExposureUnit * *now;
}

double V4l2Camera::setExposure(double seconds) {
  const double wanted = std::clamp(seconds, range_.shortest, range_.longest);
  const auto units = static_cast<std::int32_t>(std::lround(wanted / kExposureUnit));
  auto now = writeControl(*device_, V4L2_CID_EXPOSURE_ABSOLUTE, units);
  if (now != units) {  // some take it only after they were automatic once more
    (void)writeControl(*device_, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY);
    (void)writeControl(*device_, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);
    now = writeControl(*device_, V4L2_CID_EXPOSURE_ABSOLUTE, units);
  }
  if (!now || std::abs(*now - units) > std::max(1, units / 5)) {
    throw CameraError(source_ + ": it ignores the exposure time (asked for " + std::to_string(wanted) +
                      " s): set the camera itself to manual exposure");
  }
  exposure_ = kExposureUnit * *now;
  unset_ = kFramesUntilSet;
  return exposure_;
}

void V4l2Camera::start() {
  v4l2_requestbuffers wanted{};
  wanted.count = kBuffers;
  wanted.type = kCapture;
  wanted.memory = V4L2_MEMORY_MMAP;
  demand(VIDIOC_REQBUFS, &wanted, "it gives no buffers");
  for (std::uint32_t i = 0; i < wanted.count; ++i) {
    v4l2_buffer buffer{};
    buffer.type = kCapture;
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = i;
    demand(VIDIOC_QUERYBUF, &buffer, "a buffer cannot be had");
    buffers_.push_back(device_->map(buffer.length, buffer.m.offset));
    if (buffers_.back().empty()) throw CameraError(source_ + ": a buffer cannot be had: too little memory");
    giveBack(i);
  }
  auto type = static_cast<int>(kCapture);
  demand(VIDIOC_STREAMON, &type, "it does not start");
}

void V4l2Camera::giveBack(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.type = kCapture;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  demand(VIDIOC_QBUF, &buffer, "a buffer is not taken back");
}

v4l2_buffer V4l2Camera::takeBuffer() {
  v4l2_buffer buffer{};
  buffer.type = kCapture;
  buffer.memory = V4L2_MEMORY_MMAP;
  const auto patience = std::chrono::duration_cast<std::chrono::milliseconds>(kPatience + Seconds(exposure_));
  if (!device_->wait(patience)) {
    throw CameraError(source_ + ": no frame comes for " + std::to_string(patience.count() / 1000) +
                      " seconds: plug it in again, at another port if it shares one");
  }
  demand(VIDIOC_DQBUF, &buffer, "its frames cannot be read");
  if (buffer.index >= buffers_.size()) throw CameraError(source_ + ": its driver speaks of buffers that are not there");
  return buffer;
}

/// Whether the exposure began after the photograph was asked for. A time stamp may be of the frame's end.
bool V4l2Camera::isFresh(const v4l2_buffer& buffer, Clock::time_point asked, int seen) const {
  if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
    return seen > static_cast<int>(kBuffers) + 1;
  }
  const auto stamp =
      std::chrono::seconds(buffer.timestamp.tv_sec) + std::chrono::microseconds(buffer.timestamp.tv_usec);
  const bool ofItsBegin = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  const Seconds before = ofItsBegin ? Seconds(0) : std::max(period_, Seconds(exposure_)) + period_;
  return Seconds(stamp) - before >= Seconds(asked.time_since_epoch());
}

std::optional<Image8> V4l2Camera::pictureOf(const v4l2_buffer& buffer) {
  const auto bytes =
      buffers_[buffer.index].first(std::min<std::size_t>(buffer.bytesused, buffers_[buffer.index].size()));
  if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0) {
    trouble_ = "its frames are damaged";
    return std::nullopt;
  }
  try {
    Image8 picture =
        format_.layout ? developed({.layout = *format_.layout, .size = format_.size, .stride = stride_, .bytes = bytes})
                       : readJpeg(bytes);
    if (picture.size() == format_.size) return picture;
    trouble_ = "its frames are of another size than it says";
  } catch (const std::runtime_error& error) {
    trouble_ = std::string("its frames are damaged: ") + error.what();
  }
  return std::nullopt;
}

Image8 V4l2Camera::shoot() {
  const auto asked = Clock::now();
  // A long exposure outlasts many frames, and more where the driver names a slower rate than it has.
  const double exposing = std::clamp(4 * exposure_ / period_.count(), 0.0, 1000.0);
  int stale = kStaleFrames + static_cast<int>(exposing);
  int spoilt = 0;
  for (int seen = 1; spoilt < kSpoiltFrames && stale > 0; ++seen) {
    const v4l2_buffer buffer = takeBuffer();
    const bool fresh = isFresh(buffer, asked, seen) && seen > unset_;
    auto picture = fresh ? pictureOf(buffer) : std::nullopt;
    giveBack(buffer.index);
    if (picture) {
      unset_ = 0;
      return std::move(*picture);
    }
    spoilt += fresh ? 1 : 0;
    stale -= fresh ? 0 : 1;
  }
  if (stale == 0) {
    throw CameraError(source_ +
                      ": its frames are all stamped with times before they were asked for: update its driver, or "
                      "photograph by hand (--patterns DIR, --photos DIR)");
  }
  throw CameraError(source_ + ": " + trouble_ + ": try another cable or port, or fewer devices on it");
}

std::string whyNot(const std::system_error& error) {
  switch (error.code().value()) {
    case EACCES:
    case EPERM:
      return "no permission: add yourself to the group video (sudo adduser $USER video), then log in again";
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return "there is no such device: is the camera plugged in? pixelflex camera list shows those there are";
    case EBUSY:
      return "another program uses this camera: end that first";
    default:
      return error.code().message();
  }
}

std::optional<CameraInfo> infoOf(const std::filesystem::path& path) {
  CameraInfo info{.address = "v4l2:" + path.string(), .model = "-", .size = {}, .why = {}};
  try {
    const auto device = openVideoDevice(path.string());
    const auto capability = capabilityOf(*device);
    if (!capability) return std::nullopt;
    info.model = reinterpret_cast<const char*>(capability->card);
    const auto best = bestFormat(*device);
    if (best) info.size = best->size;
    if (!best) info.why = "none of its pixel formats can be read here";
  } catch (const std::system_error& error) {
    info.why = whyNot(error);
  }
  return info;
}

}  // namespace

std::vector<CameraInfo> listV4l2Cameras() {
  std::vector<CameraInfo> cameras;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored)) {
    if (!entry.path().filename().string().starts_with("video")) continue;
    if (auto info = infoOf(entry.path())) cameras.push_back(std::move(*info));
  }
  std::ranges::sort(cameras, {}, &CameraInfo::address);
  return cameras;
}

std::unique_ptr<Camera> makeV4l2Camera(const std::string& source, std::unique_ptr<VideoDevice> device) {
  return std::make_unique<V4l2Camera>(source, std::move(device));
}

std::unique_ptr<Camera> openV4l2Camera(const std::string& path) {
  const std::string source = "v4l2:" + path;
  std::unique_ptr<VideoDevice> device;
  try {
    device = openVideoDevice(path);
  } catch (const std::system_error& error) {
    throw CameraError(source + ": " + whyNot(error));
  }
  return makeV4l2Camera(source, std::move(device));
}

}  // namespace pixelflex::devices
