#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calib/store/calibration.h"
#include "calib/store/wall.h"
#include "calib/store/wall_devices.h"
#include "devices/control/setting.h"

namespace pixelflex::viewer {

/// A setting of a device and what it was when last read.
struct SettingState {
  devices::SettingInfo info;
  std::string value;  // empty: it cannot be read at all, or not now
};

/// One device as it was when last spoken to.
struct DeviceState {
  enum class Contact { kNotYet, kWell, kLost };

  calib::WallDevice device;
  Contact contact = Contact::kNotYet;
  std::string identity;
  std::vector<SettingState> settings;  // as it last had them, also while it is lost
  std::vector<std::string> actions;
  std::string trouble;  // why it is lost, or why the last command to it failed, in words; empty: all is well
  std::string doing;    // the command under way and how far it is; empty: none
  int waiting = 0;      // commands after that one

  [[nodiscard]] const SettingState* find(const std::string& setting) const {
    for (const auto& state : settings) {
      if (state.info.name == setting) return &state;
    }
    return nullptr;
  }
};

/// Something that was asked for and takes its time.
struct ConsoleJob {
  enum class Kind { kDevice, kPreset, kCalibration };

  int number = 0;
  Kind kind = Kind::kDevice;
  std::string command;  // the command line that does the same
  bool running = true;
  std::string state;              // how far it is, in words
  std::optional<double> part;     // of the whole, 0 to 1, where that is known
  std::vector<std::string> said;  // what that command line would print
  std::string error;              // why it failed; empty: it has not
};

struct LogLine {
  enum class Kind { kCommand, kNote, kError };

  std::uint64_t number = 0;  // counts from 1
  std::chrono::system_clock::time_point at;
  Kind kind = Kind::kNote;
  std::string text;
};

struct PresetInfo {
  std::string name;
  std::string saved;  // when, ISO 8601
  std::size_t devices = 0;
  bool hasCalibration = false;
  bool calibrationInUse = false;
  std::string trouble;  // why its file cannot be used
};

/// A whole wall at one moment; never changes.
struct WallSnapshot {
  std::uint64_t revision = 0;  // another one: something has changed
  std::shared_ptr<const calib::Wall> wall;
  std::vector<std::shared_ptr<const DeviceState>> devices;  // as devicesOf() orders them
  std::vector<ConsoleJob> jobs;                             // oldest first: all that run, and the last that ended
  std::vector<std::shared_ptr<const LogLine>> log;          // oldest first
  std::vector<PresetInfo> presets;
  std::shared_ptr<const calib::Calibration> calibration;  // null: none that can be used
  std::string calibrationTrouble;                         // why there is none though there is a file

  [[nodiscard]] const DeviceState* find(const std::string& device) const {
    for (const auto& state : devices) {
      if (state->device.name == device) return state.get();
    }
    return nullptr;
  }
  [[nodiscard]] const ConsoleJob* find(int job) const {
    for (const auto& each : jobs) {
      if (each.number == job) return &each;
    }
    return nullptr;
  }
};

}  // namespace pixelflex::viewer
