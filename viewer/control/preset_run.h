#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

#include "calib/store/preset.h"
#include "calib/store/wall_devices.h"
#include "devices/control/device.h"
#include "viewer/control/preset_plan.h"

namespace pixelflex::devices {
class LineLoop;
}

namespace pixelflex::viewer {

/// What came of one device.
struct PresetOutcome {
  std::string device;
  int changed = 0;    // settings
  std::string error;  // empty: it is as the preset has it
};

struct PresetRunOptions {
  std::stop_token stop = {};
  /// Called from several threads, one at a time.
  std::function<void(const std::string& device, const std::string& state)> report = {};
  std::chrono::milliseconds infocusGap = std::chrono::seconds(3);
  /// Devices that are in use already, instead of lines of its own; null for those that it shall open itself.
  std::function<std::shared_ptr<devices::Device>(const calib::WallDevice& device)> borrow = {};
};

/// A wall's devices while a preset is saved or restored: all are spoken to at the same time, one that is dead holds up
/// nobody. One thread uses it.
class PresetSession {
 public:
  PresetSession(devices::LineLoop& loop, const std::filesystem::path& folder,
                const std::vector<calib::WallDevice>& devices, PresetRunOptions options);
  ~PresetSession();
  PresetSession(const PresetSession&) = delete;
  PresetSession& operator=(const PresetSession&) = delete;

  /// What the devices are set to and the calibration. Those that could not be read are missing in it, and outcomes()
  /// says why.
  [[nodiscard]] calib::Preset capture();
  /// The same for a preset that there may be already: devices that could not be read keep what it had of them. Throws
  /// std::runtime_error when none could.
  [[nodiscard]] calib::Preset captureAs(const std::string& name);
  /// Reads what `preset` speaks of; the plan.
  [[nodiscard]] std::vector<PresetStep> prepare(const calib::Preset& preset);
  /// Stage after stage. A device that fails is left alone from then on; after a stop request only those are unmuted
  /// that were muted. `atStage` hears what begins.
  void restore(const calib::Preset& preset, const std::vector<PresetStep>& plan,
               const std::function<void(PresetStage stage)>& atStage);
  [[nodiscard]] const std::vector<PresetOutcome>& outcomes() const { return outcomes_; }

 private:
  struct Member;
  void forEach(const std::vector<Member*>& members, const std::function<void(Member&)>& action);
  [[nodiscard]] Member* find(const std::string& device);
  /// Those without errors so far.
  [[nodiscard]] std::vector<Member*> well();
  void runStage(PresetStage stage, const std::vector<PresetStep>& plan);
  [[nodiscard]] std::string useCalibration(const std::string& kept) const;
  void collect();

  std::filesystem::path folder_;
  PresetRunOptions options_;
  std::vector<std::unique_ptr<Member>> members_;
  std::vector<PresetOutcome> outcomes_;
  std::mutex reporting_;
};

}  // namespace pixelflex::viewer
