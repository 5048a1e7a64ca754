#include "devices/camera/still_camera.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "devices/camera/camera_error.h"
#include "devices/image/photo_file.h"

namespace pixelflex::devices {
namespace {

struct Speed {
  double seconds = 0;
  std::string choice;
};

/// What makes of cameras call a setting, and what it shall be, the best first.
struct Wish {
  std::string_view what;  // for messages
  std::array<std::string_view, 3> names;
  std::array<std::string_view, 4> values;  // the beginnings of choices
  bool required = true;
};
constexpr std::array kWishes = {
    Wish{"exposure mode", {"autoexposuremode", "expprogram", "exposuremode"}, {"Manual", "M"}},
    Wish{"focus mode", {"focusmode", "focusmode2", "autofocusmode"}, {"Manual", "MF"}},
    Wish{"image format", {"imageformat", "imagequality"}, {"Large Fine JPEG", "JPEG Fine", "Fine", "L"}},
    Wish{"place of photographs", {"capturetarget"}, {"Internal RAM", "sdram", "SDRAM"}, false}};
/// What may be anything but automatic.
constexpr std::array kFixed = {Wish{"sensitivity", {"iso"}, {"100", "200", "400"}},
                               Wish{"white balance", {"whitebalance"}, {"Daylight", "Sunny", "Color Temp", "Manual"}}};

/// A single letter is a whole word.
bool means(std::string_view choice, std::string_view start) {
  return start.size() > 1 ? choice.starts_with(start) : !start.empty() && choice == start;
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value <= 0) return std::nullopt;
  return value;
}

class StillCamera final : public Camera, public ExposureControl {
 public:
  StillCamera(std::string source, std::unique_ptr<StillDevice> device)
      : source_(std::move(source)), device_(std::move(device)) {
    for (const Wish& wish : kWishes) grant(wish, false);
    for (const Wish& wish : kFixed) grant(wish, true);
    readSpeeds();
    size_ = take().size();
  }
  [[nodiscard]] Size size() const override { return size_; }
  [[nodiscard]] Image8 shoot() override {
    Image8 photo = take();
    if (photo.size() != size_) throw CameraError(source_ + ": its photographs have changed their size: start again");
    return photo;
  }
  [[nodiscard]] ExposureControl* exposureControl() override { return speeds_.empty() ? nullptr : this; }
  [[nodiscard]] ExposureRange exposureRange() const override {
    return {speeds_.front().seconds, speeds_.back().seconds};
  }
  [[nodiscard]] double exposure() override { return exposure_; }
  double setExposure(double seconds) override;

 private:
  void grant(const Wish& wish, bool anyButAutomatic);
  void readSpeeds();
  [[nodiscard]] Image8 take();

  std::string source_;
  std::unique_ptr<StillDevice> device_;
  std::string speedSetting_;
  std::vector<Speed> speeds_;  // ascending
  double exposure_ = 0;
  Size size_;
};

void StillCamera::grant(const Wish& wish, bool anyButAutomatic) {
  for (const auto& name : wish.names) {
    const std::string setting(name);
    auto now = name.empty() ? std::nullopt : device_->value(setting);
    if (!now) continue;
    const auto suits = [&](const std::string& value) {
      return std::ranges::any_of(wish.values, [&](auto start) { return means(value, start); });
    };
    const bool isAutomatic = now->find("uto") != std::string::npos;
    if (anyButAutomatic ? !isAutomatic : suits(*now)) return;
    for (const auto& start : wish.values) {
      for (const auto& choice : device_->choices(setting)) {
        if (!means(choice, start)) continue;
        device_->set(setting, choice);
        now = device_->value(setting);
        if (now == choice) return;
      }
    }
    if (!wish.required) return;
    throw CameraError(source_ + ": its " + std::string(wish.what) + " stays " + now.value_or("what it was") +
                      ": set it by hand at the camera or its lens (wanted: " + std::string(wish.values.front()) + ")");
  }
}

void StillCamera::readSpeeds() {
  for (const auto* name : {"shutterspeed", "shutterspeed2"}) {
    for (const auto& choice : device_->choices(name)) {
      if (const auto seconds = shutterSeconds(choice)) speeds_.push_back({*seconds, choice});
    }
    if (speeds_.empty()) continue;
    speedSetting_ = name;
    std::ranges::sort(speeds_, {}, &Speed::seconds);
    exposure_ = shutterSeconds(device_->value(name).value_or("")).value_or(speeds_.front().seconds);
    return;
  }
}

double StillCamera::setExposure(double seconds) {
  const auto distance = [&](const Speed& speed) { return std::abs(std::log(speed.seconds / seconds)); };
  const Speed& nearest = *std::ranges::min_element(speeds_, {}, distance);
  device_->set(speedSetting_, nearest.choice);
  if (device_->value(speedSetting_) != nearest.choice) {
    throw CameraError(source_ + ": it ignores the exposure time (asked for " + nearest.choice + "): set its dial to M");
  }
  return exposure_ = nearest.seconds;
}

Image8 StillCamera::take() {
  try {
    return readJpeg(device_->capture());
  } catch (const std::runtime_error& error) {
    throw CameraError(source_ + ": it takes no photograph: " + error.what());
  }
}

}  // namespace

std::optional<double> shutterSeconds(std::string_view text) {
  while (!text.empty() && (text.back() == 's' || text.back() == '"')) text.remove_suffix(1);
  const auto slash = text.find('/');
  if (slash == std::string_view::npos) return number(text);
  const auto above = number(text.substr(0, slash));
  const auto below = number(text.substr(slash + 1));
  return above && below ? std::optional(*above / *below) : std::nullopt;
}

std::vector<CameraInfo> listStillCameras() {
  std::vector<CameraInfo> cameras;
  for (const auto& [model, port] : listStillDevices()) {
    cameras.push_back({.address = "gphoto2:" + port, .model = model, .size = {}, .why = {}});
  }
  return cameras;
}

std::unique_ptr<Camera> makeStillCamera(const std::string& source, std::unique_ptr<StillDevice> device) {
  return std::make_unique<StillCamera>(source, std::move(device));
}

std::unique_ptr<Camera> openStillCamera(const std::string& name) {
  const std::string source = "gphoto2:" + name;
  try {
    return makeStillCamera(source, openStillDevice(name));
  } catch (const CameraError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw CameraError(source + ": " + error.what());
  }
}

}  // namespace pixelflex::devices
