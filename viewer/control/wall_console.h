#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "viewer/control/wall_snapshot.h"

namespace pixelflex::viewer {

struct WallConsoleOptions {
  std::chrono::milliseconds pollEvery = std::chrono::seconds(2);  // of every device, and of the wall's files
  std::chrono::milliseconds infocusGap = std::chrono::seconds(3);
  std::filesystem::path programs = {};  // where pixelflex-calibrate is; empty: beside this program
};

/// Everything that can be done with a wall from one place, as `pixelflex device`, `preset` and `calibrate` do it. It
/// looks at all devices again and again, each on threads of its own; no call waits for a device. Thread-safe. What a
/// command comes to is told by its job in the snapshots, and every command is in their log.
class WallConsole {
 public:
  /// Throws StoreError when wall.yaml cannot be used.
  explicit WallConsole(std::filesystem::path folder, const WallConsoleOptions& options = {});
  /// Stops what runs; mirrors that were moved are halted.
  ~WallConsole();
  WallConsole(const WallConsole&) = delete;
  WallConsole& operator=(const WallConsole&) = delete;

  [[nodiscard]] std::shared_ptr<const WallSnapshot> snapshot() const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  // Each returns the number of its job.

  /// `names` and `steps` as planDevices() takes them; commands to one device are done one after the other. Throws
  /// std::invalid_argument, and std::runtime_error when too many wait for each of the devices already.
  int device(const std::string& names, const std::vector<std::string>& steps);
  /// Every mirror halts at once, whatever it is doing; commands that wait are dropped, and presets are no longer
  /// restored.
  int stopAll();

  // Only one of the following runs at a time: they throw std::runtime_error while another does.

  /// Throws StoreError for a name that is none.
  int savePreset(const std::string& name);
  /// `verify`: the camera looks afterwards how far each projector is off.
  int restorePreset(const std::string& name, bool verify);
  /// Only says what would be done, in the job's lines.
  int planPreset(const std::string& name);
  int deletePreset(const std::string& name);
  /// `pixelflex calibrate WALL` with these arguments.
  int calibrate(const std::vector<std::string>& arguments);
  /// One of those, by its number, stops as soon as it can.
  void cancel(int job);

  /// A line of the log.
  void log(LogLine::Kind kind, const std::string& text);

 private:
  struct Parts;
  [[nodiscard]] std::string commandLine(const std::string& program, const std::vector<std::string>& arguments) const;

  std::filesystem::path folder_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace pixelflex::viewer
