#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/control/device_error.h"
#include "devices/control/setting.h"

namespace pixelflex::devices {

/// A device with settings: a projector's own controls or a pan-tilt unit. Thread-safe; what is asked of one device is
/// done one after the other, on the thread that asks, and halt() goes before all. Throws DeviceError for what the
/// device says, LineError for what the line does. Connects when first used, and finds out again what it has when its
/// line was lost in between.
class Device {
 public:
  explicit Device(std::string name) : name_(std::move(name)) {}
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// "p1.mirror"
  [[nodiscard]] const std::string& name() const { return name_; }
  /// What it says that it is.
  [[nodiscard]] std::string identity();
  [[nodiscard]] std::vector<SettingInfo> settings();
  /// Those of settings() that are readable.
  [[nodiscard]] SettingValue read(std::string_view setting);
  /// Returns when it is so.
  void write(std::string_view setting, const SettingValue& value, const Progress& progress = {});
  /// By so many units, forward or back. Stops at the end of the range.
  void nudge(std::string_view setting, double by, const Progress& progress = {});
  /// "home", "reset": what is done rather than set.
  [[nodiscard]] std::vector<std::string> actions();
  void act(std::string_view action, const Progress& progress = {});
  /// Several settings at once where the device can (both axes of a mirror), else one after the other.
  void writeAll(const std::vector<std::pair<std::string, SettingValue>>& values, const Progress& progress = {});
  /// Whatever moves stops; at once, also while another thread waits for a move.
  virtual void halt() {}

 protected:
  virtual std::string doIdentity() = 0;
  virtual std::vector<SettingInfo> doSettings() = 0;
  /// One of doSettings(), for devices that take long to tell them all.
  virtual std::optional<SettingInfo> doFind(std::string_view setting);
  virtual SettingValue doRead(const SettingInfo& setting) = 0;
  virtual void doWrite(const SettingInfo& setting, const SettingValue& value, const Progress& progress) = 0;
  virtual void doNudge(const SettingInfo& setting, double by, const Progress& progress);
  virtual std::vector<std::string> doActions() { return {}; }
  virtual void doAct(std::string_view action, const Progress& progress);
  virtual void doWriteAll(const std::vector<std::pair<SettingInfo, SettingValue>>& values, const Progress& progress);

 private:
  [[nodiscard]] SettingInfo find(std::string_view setting);

  std::string name_;
  std::mutex mutex_;
};

}  // namespace pixelflex::devices
