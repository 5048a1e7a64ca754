#pragma once

#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "calib/store/wall_devices.h"
#include "devices/transport/line_loop.h"
#include "viewer/control/console_board.h"
#include "viewer/control/device_worker.h"
#include "viewer/control/long_job.h"
#include "viewer/control/preset_run.h"
#include "viewer/control/wall_console.h"
#include "viewer/control/wall_watch.h"

namespace pixelflex::viewer {

/// What a WallConsole is made of, in the order in which it may be taken down.
struct WallConsole::Parts {
  Parts(const std::filesystem::path& folder, const WallConsoleOptions& consoleOptions);
  ~Parts();
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  [[nodiscard]] DeviceWorker* workerOf(const std::string& device) const;
  /// Throws std::runtime_error when none of the jobs' devices takes one more.
  void requireRoom(const std::vector<DeviceJob>& jobs) const;
  /// Speaks through the workers' devices.
  [[nodiscard]] PresetSession presetSession(const JobView& view);
  void lookAgain() const;

  std::filesystem::path folder;
  WallConsoleOptions options;
  std::shared_ptr<const calib::Wall> wall;
  std::vector<calib::WallDevice> devices;
  ConsoleBoard board;
  devices::LineLoop loop;
  std::vector<std::unique_ptr<DeviceWorker>> workers;  // null: a device that could not even be made
  WallWatch watch;
  LongJob longJob;
};

}  // namespace pixelflex::viewer
