#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "viewer/control/device_command.h"

namespace pixelflex::devices {
class LineLoop;
}

namespace pixelflex::viewer {

/// What came of one job.
struct DeviceOutcome {
  calib::WallDevice device;
  std::string identity;                                              // where everything was read
  std::vector<std::pair<devices::SettingInfo, std::string>> values;  // read, in the order asked for
  std::string error;                                                 // empty: all went well
};

/// `report` is called from several threads, one at a time.
struct DeviceRunOptions {
  std::stop_token stop = {};
  std::function<void(const std::string& device, const std::string& state)> report = {};
  std::chrono::milliseconds infocusGap = std::chrono::seconds(3);
};

/// Does all jobs at once, each device on a thread of its own, and returns when the slowest has ended; one that is dead
/// holds up nobody. The outcomes are in the jobs' order. A stop request halts what moves.
[[nodiscard]] std::vector<DeviceOutcome> runDeviceJobs(devices::LineLoop& loop, const std::vector<DeviceJob>& jobs,
                                                       const DeviceRunOptions& options);

/// One step after the other on the calling thread; what is set in a row is set at once. What is read goes into
/// `outcome`. Throws as Device does.
void runDeviceSteps(devices::Device& device, const std::vector<DeviceStep>& steps, const devices::Progress& progress,
                    DeviceOutcome& outcome);

/// The driver of a wall's device; not connected yet. Throws DeviceError, StoreError.
[[nodiscard]] std::unique_ptr<devices::Device> openDevice(devices::LineLoop& loop, const calib::WallDevice& device,
                                                          std::chrono::milliseconds infocusGap);

}  // namespace pixelflex::viewer
