#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "devices/control/device.h"

namespace pixelflex::devices {

class LineLoop;

/// What a wall's file says about a device, and what it is called.
struct DeviceRequest {
  std::string name;           // "p1.control", for messages
  std::string driver;         // one of deviceDrivers()
  std::string at;             // see parseLineAddress()
  std::string password = {};  // for pjlink and hitachi-beef
  std::chrono::milliseconds infocusGap = std::chrono::seconds(3);
};

/// "ptu", then the projectors: "hitachi-legacy", its alias "proxima-dp6850", …
[[nodiscard]] std::vector<std::string> deviceDrivers();
[[nodiscard]] bool isPanTiltDriver(std::string_view driver);

/// Does not connect yet. Throws DeviceError for an unknown driver or an address that is none.
[[nodiscard]] std::unique_ptr<Device> makeDevice(LineLoop& loop, const DeviceRequest& request);

}  // namespace pixelflex::devices
