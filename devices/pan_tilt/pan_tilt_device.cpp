#include "devices/pan_tilt/pan_tilt_device.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pixelflex::devices {
namespace {

constexpr int kMostAcceleration = 50000;  // counts/s²

class PanTiltDevice : public Device {
 public:
  PanTiltDevice(LineLoop& loop, const LineAddress& address, const std::string& name)
      : Device(name), unit_(loop, address, name) {}

  void halt() override { unit_.halt(); }

 protected:
  std::string doIdentity() override { return unit_.version(); }

  std::vector<SettingInfo> doSettings() override {
    std::vector<SettingInfo> all;
    for (const auto axis : {PanTiltAxis::kPan, PanTiltAxis::kTilt}) {
      const PanTiltMotor& motor = unit_.motor(axis);
      const std::string word = axis == PanTiltAxis::kPan ? "pan" : "tilt";
      all.push_back({.name = word,
                     .unit = "deg",
                     .minimum = motor.degrees(motor.minimum),
                     .maximum = motor.degrees(motor.maximum),
                     .step = motor.degreesPerCount,
                     .nudgeable = true,
                     .slow = true});
      all.push_back({.name = word + "_counts",
                     .unit = "counts",
                     .minimum = 1.0 * motor.minimum,
                     .maximum = 1.0 * motor.maximum,
                     .nudgeable = true,
                     .slow = true});
      all.push_back(
          {.name = word + "_speed", .unit = "counts/s", .minimum = 1.0 * motor.lower, .maximum = 1.0 * motor.upper});
      all.push_back({.name = word + "_acceleration",
                     .unit = "counts/s2",
                     .minimum = 1,
                     .maximum = kMostAcceleration,
                     .slow = true});
    }
    all.push_back({.name = "limits", .choices = {"on", "off"}, .words = true});
    return all;
  }

  SettingValue doRead(const SettingInfo& setting) override {
    if (setting.name == "limits") return std::string(unit_.limitsEnabled() ? "on" : "off");
    const auto axis = axisOf(setting);
    const PanTiltMotor motor = unit_.motor(axis);
    if (setting.name.ends_with("_speed")) return 1.0 * motor.speed;
    if (setting.name.ends_with("_acceleration")) return 1.0 * motor.acceleration;
    const int counts = unit_.position(axis);
    return isCounts(setting) ? counts : motor.degrees(counts);
  }

  void doWrite(const SettingInfo& setting, const SettingValue& value, const Progress& progress) override {
    if (setting.name == "limits") return unit_.setLimitsEnabled(std::get<std::string>(value) == "on");
    const auto axis = axisOf(setting);
    const int number = static_cast<int>(std::lround(std::get<double>(value)));
    if (setting.name.ends_with("_speed")) return unit_.setSpeed(axis, number);
    if (setting.name.ends_with("_acceleration")) return unit_.setAcceleration(axis, number);
    move(axis, countsOf(setting, value), progress);
  }

  /// Moves of both axes are one move.
  void doWriteAll(const std::vector<std::pair<SettingInfo, SettingValue>>& values, const Progress& progress) override {
    std::optional<int> pan;
    std::optional<int> tilt;
    for (const auto& [setting, value] : values) {
      if (!isPlace(setting)) {
        doWrite(setting, value, progress);
      } else {
        (axisOf(setting) == PanTiltAxis::kPan ? pan : tilt) = countsOf(setting, value);
      }
    }
    if (pan || tilt) unit_.moveTo(pan, tilt, progress);
  }

  void doNudge(const SettingInfo& setting, double by, const Progress& progress) override {
    const auto axis = axisOf(setting);
    const PanTiltMotor motor = unit_.motor(axis);
    const double reach = motor.maximum - motor.minimum;
    const double counts = std::clamp(isCounts(setting) ? by : by / motor.degreesPerCount, -reach, reach);
    const int wanted = unit_.target(axis) + static_cast<int>(std::lround(counts));
    move(axis, std::clamp(wanted, motor.minimum, motor.maximum), progress);
  }

  std::vector<std::string> doActions() override { return {"home", "reset"}; }

  void doAct(std::string_view action, const Progress& progress) override {
    if (action == "home") return unit_.moveTo(0, 0, progress);
    unit_.reset(progress);
  }

 private:
  static PanTiltAxis axisOf(const SettingInfo& setting) {
    return setting.name.starts_with("pan") ? PanTiltAxis::kPan : PanTiltAxis::kTilt;
  }
  static bool isCounts(const SettingInfo& setting) { return setting.name.ends_with("_counts"); }
  static bool isPlace(const SettingInfo& setting) {
    return setting.name == "pan" || setting.name == "tilt" || isCounts(setting);
  }

  int countsOf(const SettingInfo& setting, const SettingValue& value) {
    const double number = std::get<double>(value);
    if (isCounts(setting)) return static_cast<int>(std::lround(number));
    return unit_.motor(axisOf(setting)).counts(number);
  }

  void move(PanTiltAxis axis, int counts, const Progress& progress) {
    if (axis == PanTiltAxis::kPan) return unit_.moveTo(counts, std::nullopt, progress);
    unit_.moveTo(std::nullopt, counts, progress);
  }

  PanTiltUnit unit_;
};

}  // namespace

std::unique_ptr<Device> makePanTiltDevice(LineLoop& loop, const LineAddress& address, const std::string& name) {
  return std::make_unique<PanTiltDevice>(loop, address, name);
}

}  // namespace pixelflex::devices
