#include "devices/camera/aravis_camera.h"

#include <arv.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "devices/camera/camera_error.h"
#include "devices/camera/raw_picture.h"

namespace pixelflex::devices {
namespace {

constexpr double kMicro = 1e-6;
constexpr int kBuffers = 4;
constexpr guint kSocketBuffer = 4U << 20U;  // as much of it as the system allows
constexpr int kAttempts = 4;                // a frame with a lost packet is taken again
constexpr double kFrameTimeout = 10;        // seconds, beside the exposure

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
template <class Object>
using Held = std::unique_ptr<Object, Unref>;

struct GiveBack {
  ArvStream* stream;
  void operator()(ArvBuffer* buffer) const { arv_stream_push_buffer(stream, buffer); }
};
/// A buffer taken from its stream.
using Taken = std::unique_ptr<ArvBuffer, GiveBack>;

/// Receives a GError; throws it as one of ours, or is asked whether there was one.
class Failure {
 public:
  explicit Failure(std::string name) : name_(std::move(name)) {}
  ~Failure() { g_clear_error(&error_); }
  Failure(const Failure&) = delete;
  Failure& operator=(const Failure&) = delete;
  [[nodiscard]] GError** place() {
    g_clear_error(&error_);
    return &error_;
  }
  [[nodiscard]] bool happened() const { return error_ != nullptr; }
  [[nodiscard]] std::string text() const { return error_ == nullptr ? "" : error_->message; }
  void check(const std::string& what) const {
    if (error_ != nullptr) throw CameraError(name_ + ": " + what + ": " + error_->message);
  }

 private:
  std::string name_;
  GError* error_ = nullptr;
};

struct Format {
  ArvPixelFormat code;
  RawLayout layout;
};
/// The best first.
constexpr std::array kFormats = {Format{0x02180014U, RawLayout::kRgb8},     Format{0x02180015U, RawLayout::kBgr8},
                                 Format{0x01080009U, RawLayout::kBayerRg8}, Format{0x01080008U, RawLayout::kBayerGr8},
                                 Format{0x0108000AU, RawLayout::kBayerGb8}, Format{0x0108000BU, RawLayout::kBayerBg8},
                                 Format{0x0210001FU, RawLayout::kUyvy},     Format{0x02100032U, RawLayout::kYuyv},
                                 Format{0x01080001U, RawLayout::kGrey8}};

std::string textOf(const char* text) {
  return text == nullptr ? "" : text;
}

/// The id of the camera that `name` means, where it answers to a search; else the name itself, perhaps an address.
std::string idOf(const std::string& name) {
  arv_update_device_list();
  for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
    const std::array names = {arv_get_device_id(i), arv_get_device_serial_nbr(i), arv_get_device_model(i),
                              arv_get_device_address(i)};
    if (name == "first" || std::ranges::any_of(names, [&](const char* its) { return name == textOf(its); })) {
      return textOf(arv_get_device_id(i));
    }
  }
  return name;
}

Held<ArvCamera> connect(const std::string& source, const std::string& name) {
  Failure failure(source);
  const std::string id = idOf(name);
  Held<ArvCamera> camera(id == "first" ? nullptr : arv_camera_new(id.c_str(), failure.place()));
  if (!camera) {
    throw CameraError(source + ": no such camera answers" + (failure.happened() ? " (" + failure.text() + ")" : "") +
                      ": check its cable, power and network address; pixelflex camera list shows those that do");
  }
  ArvDevice* device = arv_camera_get_device(camera.get());
  if (ARV_IS_GV_DEVICE(device) != 0 && arv_gv_device_is_controller(ARV_GV_DEVICE(device)) == 0) {
    throw CameraError(source + ": another program uses this camera: end that first");
  }
  return camera;
}

class AravisCamera final : public Camera, public ExposureControl {
 public:
  AravisCamera(std::string source, const std::string& name)
      : source_(std::move(source)), camera_(connect(source_, name)) {
    chooseFormat();
    chooseRegion();
    lockAutomatics();
    prepareTrigger();
    openStream();
  }
  ~AravisCamera() override {
    arv_camera_stop_acquisition(camera_.get(), nullptr);
    g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera_.get()), this);
  }
  AravisCamera(const AravisCamera&) = delete;
  AravisCamera& operator=(const AravisCamera&) = delete;

  [[nodiscard]] Size size() const override { return size_; }
  [[nodiscard]] Image8 shoot() override;
  [[nodiscard]] ExposureControl* exposureControl() override { return hasExposure_ ? this : nullptr; }
  [[nodiscard]] ExposureRange exposureRange() const override { return range_; }
  [[nodiscard]] double exposure() override { return exposure_; }
  double setExposure(double seconds) override;

 private:
  void chooseFormat();
  void chooseRegion();
  void lockAutomatics();
  void switchOff(const char* feature);
  void readExposure();
  void prepareTrigger();
  void openStream();
  void forgetFrames();
  void checkPresent() const;
  [[nodiscard]] std::optional<Image8> nextFrame(gint64 notBefore);
  [[nodiscard]] std::optional<Image8> pictureOf(ArvBuffer* buffer);

  std::string source_;
  Held<ArvCamera> camera_;
  Held<ArvStream> stream_;
  std::atomic<bool> lost_ = false;
  Format format_{};
  Size size_;
  ExposureRange range_;
  double exposure_ = 0;
  bool hasExposure_ = false;
  bool triggered_ = false;
  double period_ = 0;  // between frames that nobody triggers, seconds
  std::string trouble_;
};

void AravisCamera::chooseFormat() {
  Failure failure(source_);
  guint count = 0;
  gint64* offered = arv_camera_dup_available_pixel_formats(camera_.get(), &count, failure.place());
  failure.check("its pixel formats cannot be read");
  const std::vector<gint64> codes(offered, offered + count);
  g_free(offered);
  for (const Format& format : kFormats) {
    if (std::ranges::find(codes, static_cast<gint64>(format.code)) == codes.end()) continue;
    arv_camera_set_pixel_format(camera_.get(), format.code, failure.place());
    failure.check("its pixel format cannot be set");
    format_ = format;
    return;
  }
  throw CameraError(source_ +
                    ": none of its pixel formats can be read here: it needs RGB8, BGR8, a Bayer mosaic of 8 "
                    "bits, YUV 4:2:2 or Mono8");
}

void AravisCamera::chooseRegion() {
  Failure failure(source_);
  arv_camera_set_region(camera_.get(), 0, 0, -1, -1, nullptr);  // frees the range of the extents
  gint least = 0;
  Size whole;
  arv_camera_get_width_bounds(camera_.get(), &least, &whole.width, failure.place());
  failure.check("its width cannot be read");
  arv_camera_get_height_bounds(camera_.get(), &least, &whole.height, failure.place());
  failure.check("its height cannot be read");
  arv_camera_set_region(camera_.get(), 0, 0, whole.width, whole.height, failure.place());
  failure.check("its whole sensor cannot be chosen");
  gint x = 0;
  gint y = 0;
  arv_camera_get_region(camera_.get(), &x, &y, &size_.width, &size_.height, failure.place());
  failure.check("its picture's extent cannot be read");
}

/// Off, and still off when it is read back; a camera without the feature has nothing to switch off.
void AravisCamera::switchOff(const char* feature) {
  Failure failure(source_);
  if (arv_camera_is_feature_available(camera_.get(), feature, nullptr) == 0) return;
  arv_camera_set_string(camera_.get(), feature, "Off", failure.place());
  const std::string now = textOf(arv_camera_get_string(camera_.get(), feature, nullptr));
  if (now != "Off") {
    throw CameraError(source_ + ": " + feature + " stays " + now + ": switch it off in the camera's own settings");
  }
}

void AravisCamera::lockAutomatics() {
  for (const char* feature : {"ExposureAuto", "GainAuto", "BalanceWhiteAuto", "BlackLevelAuto"}) switchOff(feature);
  if (arv_camera_is_feature_available(camera_.get(), "GammaEnable", nullptr) != 0) {
    arv_camera_set_boolean(camera_.get(), "GammaEnable", FALSE, nullptr);
  }
  readExposure();
}

void AravisCamera::readExposure() {
  Failure failure(source_);
  hasExposure_ = arv_camera_is_exposure_time_available(camera_.get(), nullptr) != 0;
  if (!hasExposure_) return;
  arv_camera_get_exposure_time_bounds(camera_.get(), &range_.shortest, &range_.longest, failure.place());
  failure.check("the range of its exposure cannot be read");
  range_ = {range_.shortest * kMicro, range_.longest * kMicro};
  exposure_ = arv_camera_get_exposure_time(camera_.get(), failure.place()) * kMicro;
  failure.check("its exposure cannot be read");
}

double AravisCamera::setExposure(double seconds) {
  checkPresent();
  Failure failure(source_);
  const double wanted = std::clamp(seconds, range_.shortest, range_.longest);
  arv_camera_set_exposure_time(camera_.get(), std::round(wanted / kMicro), failure.place());
  failure.check("its exposure cannot be set");
  exposure_ = arv_camera_get_exposure_time(camera_.get(), failure.place()) * kMicro;
  failure.check("its exposure cannot be read");
  if (std::abs(exposure_ - wanted) > 0.2 * wanted) {
    throw CameraError(source_ + ": it ignores the exposure time (asked for " + std::to_string(wanted) +
                      " s, it stays at " + std::to_string(exposure_) + " s): set the camera itself to manual exposure");
  }
  return exposure_;
}

void AravisCamera::prepareTrigger() {
  Failure failure(source_);
  arv_camera_set_acquisition_mode(camera_.get(), ARV_ACQUISITION_MODE_CONTINUOUS, nullptr);
  triggered_ = arv_camera_is_software_trigger_supported(camera_.get(), nullptr) != 0;
  if (triggered_) {
    arv_camera_set_trigger(camera_.get(), "Software", failure.place());
    triggered_ = !failure.happened();
  }
  if (triggered_) return;
  arv_camera_clear_triggers(camera_.get(), nullptr);
  const double rate = arv_camera_get_frame_rate(camera_.get(), nullptr);
  period_ = rate > 0 ? 1 / rate : 0.2;
}

void AravisCamera::openStream() {
  Failure failure(source_);
  ArvDevice* device = arv_camera_get_device(camera_.get());
  const auto lose = +[](ArvDevice*, AravisCamera* self) { self->lost_ = true; };
  g_signal_connect(device, "control-lost", G_CALLBACK(lose), this);
  const guint payload = arv_camera_get_payload(camera_.get(), failure.place());
  failure.check("the size of its frames cannot be read");
  const bool network = arv_camera_is_gv_device(camera_.get()) != 0;
  // With the rights to use raw sockets the library would, and hear nothing of cameras at this machine's own address.
  if (network) arv_camera_gv_set_stream_options(camera_.get(), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  stream_.reset(arv_camera_create_stream(camera_.get(), nullptr, nullptr, failure.place()));
  failure.check("its stream cannot be opened");
  if (network) {
    g_object_set(stream_.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size",
                 static_cast<gint>(std::max(payload, kSocketBuffer)), "packet-timeout", 40000U, "frame-retention",
                 1000000U, nullptr);
  }
  for (int i = 0; i < kBuffers; ++i) arv_stream_push_buffer(stream_.get(), arv_buffer_new_allocate(payload));
  arv_camera_start_acquisition(camera_.get(), failure.place());
  failure.check("it does not start");
}

void AravisCamera::checkPresent() const {
  if (lost_) throw CameraError(source_ + ": the camera is gone: check its cable and power, then start again");
}

/// Whatever has arrived was asked for earlier.
void AravisCamera::forgetFrames() {
  while (ArvBuffer* buffer = arv_stream_try_pop_buffer(stream_.get())) arv_stream_push_buffer(stream_.get(), buffer);
}

std::optional<Image8> AravisCamera::pictureOf(ArvBuffer* buffer) {
  if (arv_buffer_get_status(buffer) != ARV_BUFFER_STATUS_SUCCESS) {
    trouble_ = "a frame came with parts missing (status " + std::to_string(arv_buffer_get_status(buffer)) + ")";
    return std::nullopt;
  }
  std::size_t bytes = 0;
  const auto* data = static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer, &bytes));
  const Size size{arv_buffer_get_image_width(buffer), arv_buffer_get_image_height(buffer)};
  if (size != size_ || arv_buffer_get_image_pixel_format(buffer) != format_.code) {
    throw CameraError(source_ + ": a frame of another size or pixel format than was asked for: start again");
  }
  try {
    return developed({.layout = format_.layout, .size = size, .bytes = std::span(data, bytes)});
  } catch (const std::runtime_error& error) {
    trouble_ = std::string("its frames are damaged: ") + error.what();
    return std::nullopt;
  }
}

/// None when a frame was spoilt or does not come.
std::optional<Image8> AravisCamera::nextFrame(gint64 notBefore) {
  const gint64 end = g_get_monotonic_time() + std::llround((kFrameTimeout + exposure_ + period_) / kMicro);
  for (gint64 now = g_get_monotonic_time(); now < end; now = g_get_monotonic_time()) {
    checkPresent();
    const auto patience = static_cast<guint64>(std::min<gint64>(end - now, 500000));
    const Taken buffer(arv_stream_timeout_pop_buffer(stream_.get(), patience), {stream_.get()});
    if (!buffer) continue;
    const bool stale = static_cast<gint64>(arv_buffer_get_system_timestamp(buffer.get()) / 1000) < notBefore;
    if (!stale) return pictureOf(buffer.get());
  }
  trouble_ = "no frame comes";
  return std::nullopt;
}

Image8 AravisCamera::shoot() {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    checkPresent();
    Failure failure(source_);
    if (attempt > 0) {  // what the attempt before has left under way must not be taken for this one's
      arv_camera_stop_acquisition(camera_.get(), nullptr);
      arv_camera_start_acquisition(camera_.get(), failure.place());
      failure.check("it does not start again");
    }
    forgetFrames();
    const gint64 now = g_get_real_time();
    if (triggered_) arv_camera_software_trigger(camera_.get(), failure.place());
    failure.check("it cannot be triggered");
    // A frame is sent when its exposure is over; one that runs by itself may be exposing already.
    const double head = triggered_ ? 0 : exposure_ + period_;
    if (auto picture = nextFrame(now + std::llround(head / kMicro))) return std::move(*picture);
  }
  throw CameraError(source_ + ": " + trouble_ +
                    ": check its cable, its network link and the firewall (UDP from the "
                    "camera), or lower the load on the network");
}

}  // namespace

std::vector<CameraInfo> listAravisCameras() {
  std::vector<CameraInfo> cameras;
  arv_update_device_list();
  for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
    const std::string id = textOf(arv_get_device_id(i));
    const std::string place = textOf(arv_get_device_address(i));
    cameras.push_back({.address = "aravis:" + id,
                       .model = textOf(arv_get_device_vendor(i)) + " " + textOf(arv_get_device_model(i)) +
                                (place.empty() ? "" : " at " + place)});
  }
  return cameras;
}

std::unique_ptr<Camera> openAravisCamera(const std::string& name) {
  return std::make_unique<AravisCamera>("aravis:" + name, name);
}

}  // namespace pixelflex::devices
