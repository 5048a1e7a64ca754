#pragma once

#include <string>
#include <vector>

#include "viewer/control/device_run.h"

namespace pixelflex::viewer {

/// A table of devices, one a line: what each is and does, or what is wrong with it.
[[nodiscard]] std::string deviceTable(const std::vector<DeviceOutcome>& outcomes);

/// "p1.control brightness 64" for every value, in columns; devices with errors have no lines.
[[nodiscard]] std::string deviceValues(const std::vector<DeviceOutcome>& outcomes);

/// All of it as a JSON array of objects with device, driver, at, ok, and identity, values or error.
[[nodiscard]] std::string deviceJson(const std::vector<DeviceOutcome>& outcomes);

}  // namespace pixelflex::viewer
