#pragma once

#include <string>
#include <variant>
#include <vector>

#include "calib/store/wall_devices.h"
#include "devices/control/device.h"

namespace pixelflex::viewer {

/// One thing to do with a device.
struct DeviceStep {
  enum class Kind { kRead, kWrite, kNudge, kAct, kHalt };
  Kind kind = Kind::kRead;
  std::string name;   // of the setting, or the action
  std::string value;  // kWrite
  double by = 0;      // kNudge
  bool operator==(const DeviceStep&) const = default;
};

/// `pan`, `pan=12.5`, `pan+=2`, `pan-=2`, `home`, `reset`, `halt`. Throws std::invalid_argument.
[[nodiscard]] DeviceStep parseDeviceStep(const std::string& text);

/// Whether the step is for a mirror rather than for a projector's control.
[[nodiscard]] bool isForMirror(const DeviceStep& step);

/// What is to be done with one device, one after the other; without steps all is read.
struct DeviceJob {
  calib::WallDevice device;
  std::vector<DeviceStep> steps;
  [[nodiscard]] bool moves() const;
};

/// `names`: "all", or "p1,p2.mirror"; a projector's name means both its devices, of which each gets the steps that are
/// for it. Throws std::invalid_argument for names that are none and steps that nobody can take.
[[nodiscard]] std::vector<DeviceJob> planDevices(const std::vector<calib::WallDevice>& devices,
                                                 const std::string& names, const std::vector<std::string>& steps);

}  // namespace pixelflex::viewer
